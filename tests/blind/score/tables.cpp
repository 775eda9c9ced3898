#include "score/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

namespace blind::score {
namespace {

constexpr const char* kNothing = "–";

std::string Formatted(const char* format, double value) {
  if (std::isnan(value)) return kNothing;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string Percent(double share) {
  return Formatted("%.1f %%", 100.0 * share);
}

std::string InWords(const Rate& rate) {
  if (rate.all == 0) return kNothing;
  const double share = static_cast<double>(rate.hits) / static_cast<double>(rate.all);
  return Percent(share) + " (" + std::to_string(rate.hits) + "/" + std::to_string(rate.all) + ")";
}

std::string WithBound(const Rate& rate) {
  if (rate.all == 0) return kNothing;
  return InWords(rate) + ", at most " + Percent(ClopperPearsonUpper(rate.hits, rate.all, 0.95));
}

std::string MeanOf(const std::vector<double>& values) {
  return values.empty() ? kNothing : Formatted("%.2f", Mean(values));
}

std::string CountedMean(const std::vector<double>& values) {
  return values.empty()
             ? kNothing
             : Formatted("%.3f", Mean(values)) + " (" + std::to_string(values.size()) + ")";
}

std::string OfForecasts(double (*score)(const std::vector<Forecast>&), const Figures& figures) {
  if (figures.forecasts.empty()) return kNothing;
  return Formatted("%.3f", score(figures.forecasts)) + " (" +
         std::to_string(figures.forecasts.size()) + ")";
}

struct Row {
  const char* title;
  std::function<std::string(const Figures&)> cell;
};

std::vector<Row> Rows() {
  return {
      {"single effects: top-1", [](const Figures& f) { return InWords(f.all.top_1); }},
      {"top-3", [](const Figures& f) { return InWords(f.all.top_3); }},
      {"class hit", [](const Figures& f) { return InWords(f.all.class_hit); }},
      {"class hit, named for sure", [](const Figures& f) { return InWords(f.all.named_hit); }},
      {"mean class size", [](const Figures& f) { return MeanOf(f.all.class_sizes); }},
      {"of those with d >= 10: top-1",
       [](const Figures& f) { return InWords(f.detectable.top_1); }},
      {"top-3", [](const Figures& f) { return InWords(f.detectable.top_3); }},
      {"class hit", [](const Figures& f) { return InWords(f.detectable.class_hit); }},
      {"class hit, named for sure",
       [](const Figures& f) { return InWords(f.detectable.named_hit); }},
      {"mean class size", [](const Figures& f) { return MeanOf(f.detectable.class_sizes); }},
      {"of those that show by 10 sigmas as large as they are: top-1",
       [](const Figures& f) { return InWords(f.detectable_as_it_is.top_1); }},
      {"class hit, named for sure",
       [](const Figures& f) { return InWords(f.detectable_as_it_is.named_hit); }},
      {"false alarms on nominal (95 % bound)",
       [](const Figures& f) { return WithBound(f.false_alarms); }},
      {"weather of nominal days the first cause",
       [](const Figures& f) { return InWords(f.weather_named); }},
      {"unknowns wrongly named (95 % bound)",
       [](const Figures& f) { return WithBound(f.wrongly_named); }},
      {"unknowns seen at all", [](const Figures& f) { return InWords(f.outside_seen); }},
      {"both of two effects", [](const Figures& f) { return InWords(f.exact_pairs); }},
      {"at least one of two", [](const Figures& f) { return InWords(f.half_pairs); }},
      {"true effect left out: another named for sure (95 % bound)",
       [](const Figures& f) { return WithBound(f.confidently_wrong); }},
      {"of them by none that is known to look like it",
       [](const Figures& f) { return WithBound(f.unrelated_named); }},
      {"of these by more than the weather that is there",
       [](const Figures& f) { return WithBound(f.absent_named); }},
      {"true effect left out: one of its class named",
       [](const Figures& f) { return InWords(f.indistinguishable_named); }},
      {"Brier (forecasts)", [](const Figures& f) { return OfForecasts(Brier, f); }},
      {"calibration error (forecasts)",
       [](const Figures& f) { return OfForecasts(CalibrationError, f); }},
      {"median closure where named",
       [](const Figures& f) { return Formatted("%.3f", Median(f.closures)); }},
      {"mean abs(predicted - realised closure) (cases)",
       [](const Figures& f) { return CountedMean(f.closure_errors); }},
      {"the same where the cause is named for sure",
       [](const Figures& f) { return CountedMean(f.named_closure_errors); }},
  };
}

std::string DirectionTable(const Method& method) {
  if (method.figures.directions.empty()) return "";
  std::string text = "\n### " + method.name +
                     ", directions of weather that the first cause names\n"
                     "| weather | told | held by its 95 % interval | median half-width, degrees |\n"
                     "|---|---|---|---|\n";
  for (const auto& [weather, direction] : method.figures.directions) {
    text += "| " + weather + " | " + InWords(direction.told) + " | " + InWords(direction.held) +
            " | " + Formatted("%.0f", Median(direction.half_widths_deg)) + " |\n";
  }
  return text;
}

std::string CalledAs(const EffectFigures& effect) {
  using Entry = std::pair<std::string, std::size_t>;
  std::vector<Entry> entries(effect.called.begin(), effect.called.end());
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, count] : entries) {
    text += (text.empty() ? "" : ", ") + name + " " + std::to_string(count);
  }
  return text;
}

std::string EffectTable(const Method& method) {
  std::string text = "\n### " + method.name +
                     ", by true effect\n"
                     "| true | median d | top-1 | class hit | class size | called |\n"
                     "|---|---|---|---|---|---|\n";
  for (const auto& [name, effect] : method.figures.effects) {
    text += "| " + name + " | " + Formatted("%.1f", Median(effect.detectability)) + " | " +
            InWords(effect.naming.top_1) + " | " + InWords(effect.naming.class_hit) + " | " +
            MeanOf(effect.naming.class_sizes) + " | " + CalledAs(effect) + " |\n";
  }
  return text;
}

}  // namespace

std::string Markdown(const std::vector<Method>& methods, std::size_t cases) {
  std::string text = "| " + std::to_string(cases) + " cases |";
  for (const Method& method : methods) text += " " + method.name + " |";
  text += "\n|---|";
  for (std::size_t column = 0; column < methods.size(); ++column) text += "---|";
  text += '\n';
  for (const Row& row : Rows()) {
    text += std::string("| ") + row.title + " |";
    for (const Method& method : methods) {
      text += " " + row.cell(method.figures) + " |";
    }
    text += '\n';
  }
  for (const Method& method : methods) text += DirectionTable(method) + EffectTable(method);
  return text;
}

}  // namespace blind::score
