#include <algorithm>

#include "telltale/client/report/diagnosis_text.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/plot.hpp"

namespace telltale {
namespace {

constexpr double kBarLength = 100.0;  // the picture is scaled to its column
constexpr double kBarHeight = 22.0;

double HighestOf(const GapSize& size) {
  return LargestFinite({size.before, size.after, size.floor_limit});
}

double HighestOf(const Gap& gap) {
  double highest = HighestOf(gap.all);
  for (const GapSize& channel : gap.channels) highest = std::max(highest, HighestOf(channel));
  return highest;
}

std::string BarDescription(std::string_view name, const GapSize& size, bool after) {
  return std::string(name) + ": before " + Fixed(size.before, 2) +
         (after ? ", after " + Fixed(size.after, 2) : "") + ", floor " +
         Fixed(size.noise_floor, 2) + ", 95 % of nominal recordings below " +
         Fixed(size.floor_limit, 2) + " times the normal error";
}

Markup Bars(std::string_view name, const GapSize& size, double highest, bool after) {
  const Axis x{0.0, highest, 0.0, kBarLength};
  const double thickness = after ? 7.0 : 12.0;
  Markup shapes =
      RectangleShape({0.0, 0.0}, {x(size.floor_limit), kBarHeight}, "floor-band") +
      RectangleShape({0.0, after ? 3.0 : 5.0}, {x(size.before), thickness}, "before-bar");
  if (after) shapes += RectangleShape({0.0, 12.0}, {x(size.after), thickness}, "after-bar");
  shapes += LineShape({x(size.noise_floor), 0.0}, {x(size.noise_floor), kBarHeight}, "floor-line");
  const std::string description = BarDescription(name, size, after);
  return Element("svg",
                 {{"class", "bars"},
                  {"viewBox", "0 0 " + Pixels(kBarLength) + ' ' + Pixels(kBarHeight)},
                  {"preserveAspectRatio", "none"},
                  {"role", "img"},
                  {"aria-label", description}},
                 Titled(description, shapes));
}

Markup BarNumbers(const GapSize& size, const std::optional<ExcessExplained>& excess_explained,
                  bool after) {
  Markup numbers = Styled("b", "before-text", Words(Fixed(size.before, 2)));
  if (after) {
    numbers += Words(" → ") + Styled("b", "after-text", Words(Fixed(size.after, 2)));
  }
  Markup excess_text;
  if (excess_explained)
    excess_text = Styled("span", "soft", Words(ExcessExplainedText(excess_explained)));
  return Styled("span", "figures", Styled("span", "", numbers) + excess_text);
}

Markup BarRow(std::string_view name, const GapSize& size,
              const std::optional<ExcessExplained>& excess_explained, double highest, bool after) {
  return Styled("div", "bar-row",
                Styled("span", "name", Words(name)) + BarNumbers(size, excess_explained, after) +
                    Bars(name, size, highest, after));
}

Markup HorizonBars(const Gap& gap, double highest, bool after) {
  const std::string title = Plain(gap.horizon_s) + " s ahead";
  Markup rows = Styled("h3", "", Words(title));
  if (gap.windows == 0) {
    return Styled("div", "horizon", rows + Nothing("No segment without gaps is this long."));
  }
  rows += BarRow("all", gap.all, gap.excess_explained, highest, after);
  for (const Equation channel : kEquations) {
    const std::size_t i = IndexOf(channel);
    rows += BarRow(ChannelText(channel), gap.channels[i], gap.channel_excess_explained[i], highest,
                   after);
  }
  return Styled("div", "horizon",
                rows + Styled("p", "soft", Words(Counted(gap.windows, "window", "windows"))));
}

}  // namespace

Markup GapBars(const Diagnosis& diagnosis) {
  double highest = 1.0;
  for (const Gap& gap : diagnosis.gaps) {
    if (gap.windows > 0) highest = std::max(highest, HighestOf(gap));
  }
  Markup horizons;
  for (const Gap& gap : diagnosis.gaps) horizons += HorizonBars(gap, highest, HasAfter(diagnosis));
  return Styled("div", "of-bars", Legend(diagnosis, false)) + Styled("div", "columns", horizons);
}

}  // namespace telltale
