#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/plot.hpp"
#include "telltale/idl/codec/json/report.hpp"

namespace telltale {
namespace {

using Path = std::vector<Eigen::Vector2d>;

constexpr double kPathWidth = 280.0;
constexpr double kPathHeight = 215.0;
constexpr double kPathMargin = 18.0;

/// North, east in metres to pixels, north up, alike in both directions.
struct Chart {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double pixels_per_m = 1.0;

  Eigen::Vector2d operator()(const Eigen::Vector2d& point) const {
    return {kPathWidth / 2.0 + pixels_per_m * (point.y() - middle.y()),
            (kPathHeight - 24.0) / 2.0 - pixels_per_m * (point.x() - middle.x())};
  }
};

/// As far as a prediction stays on the map: a model that diverges leaves it at once.
Path OnTheMap(const Path& predicted, const Eigen::Vector2d& middle, double reach_m) {
  Path kept;
  for (const Eigen::Vector2d& point : predicted) {
    if (!((point - middle).norm() < reach_m)) break;
    kept.push_back(point);
  }
  return kept;
}

Chart ChartOf(const std::vector<const Path*>& paths) {
  Eigen::AlignedBox2d box;
  for (const Path* path : paths) {
    for (const Eigen::Vector2d& point : *path) box.extend(point);
  }
  const Eigen::Vector2d extent = box.sizes().cwiseMax(0.1);
  const double across = (kPathWidth - 2.0 * kPathMargin) / extent.y();
  const double up = (kPathHeight - 24.0 - 2.0 * kPathMargin) / extent.x();
  return {box.center(), std::min(across, up)};
}

Markup DrawPath(const Chart& chart, const Path& path, const std::string& style) {
  if (path.empty()) return {};
  Path points;
  for (const Eigen::Vector2d& point : path) points.push_back(chart(point));
  return PathShape(points, style + "-path") + CircleShape(points.back(), 4.0, style + "-end");
}

/// A round length that is about a quarter of the picture.
Markup ScaleBar(const Chart& chart) {
  const double length_m = TicksUpTo(kPathWidth / chart.pixels_per_m, 8)[1];
  const double pixels = length_m * chart.pixels_per_m;
  const double y = kPathHeight - 10.0;
  return LineShape({kPathMargin, y}, {kPathMargin + pixels, y}, "scale") +
         LabelShape({kPathMargin + pixels + 8.0, y + 5.0}, Plain(length_m) + " m", Anchor::kStart);
}

Markup NorthArrow() {
  const double x = kPathWidth - kPathMargin;
  const double y = kPathHeight - 8.0;
  return PathShape({{x - 4.0, y - 12.0}, {x, y - 20.0}, {x + 4.0, y - 12.0}}, "arrow") +
         LineShape({x, y - 20.0}, {x, y}, "scale") +
         LabelShape({x - 10.0, y - 3.0}, "N", Anchor::kEnd);
}

std::string WindowCaption(const WindowPicture& window, double start_s, bool after) {
  return Fixed(window.time_s - start_s, 0) + " s: " + std::string(Name(window.region)) + ", " +
         Fixed(window.speed_m_s, 1) + " m/s, error " + Fixed(window.before, 1) +
         (after ? " → " + Fixed(window.after, 1) : "");
}

Markup WindowFigure(const WindowPicture& window, double start_s, bool after) {
  const Eigen::Vector2d middle = window.measured[window.measured.size() / 2];
  Eigen::AlignedBox2d measured_box;
  for (const Eigen::Vector2d& point : window.measured) measured_box.extend(point);
  const double reach_m = 3.0 * measured_box.sizes().norm() + 2.0;
  const Path before = OnTheMap(window.predicted_before, middle, reach_m);
  const Path predicted_after = after ? OnTheMap(window.predicted_after, middle, reach_m) : Path();
  const Chart chart = ChartOf({&window.measured, &before, &predicted_after});
  const Markup shapes =
      DrawPath(chart, window.measured, "measured") + DrawPath(chart, before, "before") +
      DrawPath(chart, predicted_after, "after") +
      CircleShape(chart(window.measured.front()), 4.0, "start") + ScaleBar(chart) + NorthArrow();
  const std::string caption = WindowCaption(window, start_s, after);
  return Styled("figure", "",
                Picture({kPathWidth, kPathHeight}, "path",
                        "Path measured and predicted, " + caption, shapes) +
                    Element("figcaption", {}, Words(caption)));
}

}  // namespace

Markup PathPictures(const Diagnosis& diagnosis) {
  Markup figures;
  for (const std::size_t i : WorstWindows(diagnosis.pictures)) {
    figures += WindowFigure(diagnosis.pictures[i], diagnosis.start_s, HasAfter(diagnosis));
  }
  if (figures.Text().empty()) return Nothing("No paths were kept to draw.");
  return Legend(diagnosis, true) + Styled("div", "paths", figures);
}

}  // namespace telltale
