#include <array>
#include <cmath>
#include <numbers>

#include "telltale/client/report/grouped_error.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/plot.hpp"
#include "telltale/core/vessel/compass.hpp"

namespace telltale {
namespace {

constexpr double kOctantRad = std::numbers::pi / 4.0;
constexpr double kRoseSize = 300.0;
constexpr double kRoseRadius = 114.0;

using Rose = std::array<GroupedError, kCompassPoints.size()>;

Rose RoseOf(const std::vector<WindowPicture>& windows) {
  Rose rose;
  for (const WindowPicture& window : windows) {
    if (std::isfinite(window.psi_rad)) rose[NearestCompassPoint(window.psi_rad)].Add(window);
  }
  return rose;
}

/// Clockwise from north, as a compass is read.
Eigen::Vector2d OnRose(double angle_rad, double radius) {
  return {kRoseSize / 2.0 + radius * std::sin(angle_rad),
          kRoseSize / 2.0 - radius * std::cos(angle_rad)};
}

Markup Wedge(std::size_t octant, double radius, double half_width_rad, std::string_view style) {
  constexpr int kSteps = 8;
  std::vector<Eigen::Vector2d> points = {OnRose(0.0, 0.0)};
  const double middle = static_cast<double>(octant) * kOctantRad;
  for (int i = -kSteps; i <= kSteps; ++i) {
    points.push_back(OnRose(middle + half_width_rad * i / kSteps, radius));
  }
  points.push_back(OnRose(0.0, 0.0));
  return PathShape(points, style);
}

std::string OctantText(std::size_t octant, const GroupedError& group, bool after) {
  std::string text(kCompassPoints[octant]);
  if (group.Windows() == 0) return text + " no data";
  text += " " + Fixed(group.Before(), 1);
  return after ? text + " before, " + Fixed(group.After(), 1) + " after" : text;
}

std::string RoseDescription(const Rose& rose, bool after) {
  std::string text = "Error by heading, times the normal error: ";
  for (std::size_t i = 0; i < rose.size(); ++i) {
    text += (i > 0 ? "; " : "") + OctantText(i, rose[i], after);
  }
  return text + ".";
}

Markup Rings(const Axis& radius, const std::vector<double>& ticks) {
  Markup rings;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    rings += CircleShape(OnRose(0.0, 0.0), radius(ticks[i]), "ring");
  }
  return rings;
}

Markup RoseLabels(const Axis& radius, const std::vector<double>& ticks, const Rose& rose) {
  Markup labels;
  for (std::size_t i = 0; i < kCompassPoints.size(); ++i) {
    const double angle = static_cast<double>(i) * kOctantRad;
    const Eigen::Vector2d at = OnRose(angle, kRoseRadius + 18.0);
    labels += LabelShape({at.x(), at.y() + 5.0}, kCompassPoints[i], Anchor::kMiddle,
                         rose[i].Windows() == 0 ? "faint" : "strong");
  }
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const Eigen::Vector2d at = OnRose(1.5 * kOctantRad, radius(ticks[i]));
    labels += LabelShape({at.x() - 3.0, at.y() + 5.0}, Plain(ticks[i]), Anchor::kEnd, "halo");
  }
  return labels;
}

}  // namespace

Markup HeadingRose(const Diagnosis& diagnosis) {
  if (diagnosis.pictures.empty()) return Nothing("No windows were kept to sort by heading.");
  const Rose rose = RoseOf(diagnosis.pictures);
  const bool after = HasAfter(diagnosis);
  std::vector<double> errors;
  for (const GroupedError& group : rose)
    errors.insert(errors.end(), {group.Before(), group.After()});
  const std::vector<double> ticks = TicksUpTo(LargestFinite(errors), 3);
  const Axis radius{0.0, ticks.back(), 0.0, kRoseRadius};
  Markup wedges;
  for (std::size_t i = 0; i < rose.size(); ++i) {
    if (rose[i].Windows() == 0) continue;
    Markup octant = Wedge(i, radius(rose[i].Before()), 0.46 * kOctantRad, "before-wedge");
    if (after) octant += Wedge(i, radius(rose[i].After()), 0.28 * kOctantRad, "after-wedge");
    wedges += Titled(OctantText(i, rose[i], after) + ", times the normal error", octant);
  }
  return Picture({kRoseSize, kRoseSize}, "rose", RoseDescription(rose, after),
                 Rings(radius, ticks) + wedges + RoseLabels(radius, ticks, rose));
}

}  // namespace telltale
