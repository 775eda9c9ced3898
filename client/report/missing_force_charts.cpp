#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "telltale/client/report/diagnosis_text.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/plot.hpp"

namespace telltale {
namespace {

constexpr double kWidth = 300.0;
constexpr double kHeight = 170.0;
constexpr double kLeftEdge = 46.0;
constexpr double kRightEdge = 8.0;
constexpr double kTopEdge = 26.0;
constexpr double kBottomEdge = 24.0;

/// The largest force of a component that any chart has to show, with its interval.
double LargestOf(const MissingForce& missing, std::size_t component) {
  std::vector<double> ends;
  for (const ForceProfile& profile : missing.over) {
    for (const ForceBin& bin : profile.bins) {
      const ForceMean& force = bin.force[component];
      ends.push_back(std::abs(force.mean) + force.half_width);
    }
  }
  return LargestFinite(ends);
}

std::string BinText(const ForceBin& bin, std::size_t component) {
  return BinEndText(bin, bin.low) + " to " + BinEndText(bin, bin.high) + ": " +
         Fixed(bin.force[component].mean, 2) + " ± " + Fixed(bin.force[component].half_width, 2);
}

std::string ChartDescription(const ForceProfile& profile, std::size_t component) {
  std::string text = std::string(ForceText(component)) + " over " +
                     std::string(VariableText(profile.variable)) + ": ";
  for (std::size_t i = 0; i < profile.bins.size(); ++i) {
    const ForceBin& bin = profile.bins[i];
    text += (i > 0 ? "; " : "") + BinText(bin, component);
  }
  return text + ".";
}

Markup ForceChart(const ForceProfile& profile, std::size_t component, double largest) {
  const std::vector<double> ticks = TicksUpTo(largest, 2);
  const double end = ticks.back();
  const Axis y{-end, end, kHeight - kBottomEdge, kTopEdge};
  const Axis x{profile.bins.front().low, profile.bins.back().high, kLeftEdge, kWidth - kRightEdge};
  Markup shapes;
  for (const double force : {-end, 0.0, end}) {
    shapes += LineShape({x.from, y(force)}, {x.to, y(force)}, "grid");
    shapes += LabelShape({x.from - 6.0, y(force) + 5.0}, Plain(force), Anchor::kEnd);
  }
  for (const ForceBin& bin : profile.bins) {
    const ForceMean& force = bin.force[component];
    const double middle = x(0.5 * (bin.low + bin.high));
    shapes += Titled(BinText(bin, component),
                     LineShape({middle, y(force.mean - force.half_width)},
                               {middle, y(force.mean + force.half_width)}, "whisker") +
                         CircleShape({middle, y(force.mean)}, 4.0, "whisker-dot"));
  }
  shapes += LabelShape({4.0, 14.0}, std::string(ForceText(component)), Anchor::kStart, "strong");
  shapes +=
      LabelShape({x.from, kHeight - 6.0}, BinEndText(profile.bins.front(), x.low), Anchor::kStart);
  shapes +=
      LabelShape({x.to, kHeight - 6.0}, BinEndText(profile.bins.back(), x.high), Anchor::kEnd);
  return Picture({kWidth, kHeight}, "force", ChartDescription(profile, component), shapes);
}

Markup ProfileCharts(const ForceProfile& profile, const std::array<double, 3>& largest) {
  Markup charts;
  for (std::size_t component = 0; component < largest.size(); ++component) {
    charts += ForceChart(profile, component, largest[component]);
  }
  return Styled(
      "div", "",
      Styled("h3", "", Words("Over " + std::string(VariableText(profile.variable)))) + charts);
}

}  // namespace

Markup MissingForceCharts(const Diagnosis& diagnosis) {
  if (!diagnosis.missing_force) {
    return Nothing("Nothing stays unexplained that would be a force.");
  }
  const MissingForce& missing = *diagnosis.missing_force;
  const std::array largest = {LargestOf(missing, 0), LargestOf(missing, 1), LargestOf(missing, 2)};
  Markup charts;
  for (const ForceProfile& profile : missing.over) {
    const bool varies =
        !profile.bins.empty() && profile.bins.back().high > profile.bins.front().low;
    if (varies) charts += ProfileCharts(profile, largest);
  }
  return Styled("p", "says", Words("Missing is " + missing.sentence + ".")) +
         Styled("div", "columns", charts);
}

}  // namespace telltale
