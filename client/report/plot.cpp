#include "telltale/client/report/plot.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/client/report/number_text.hpp"

namespace telltale {

double Axis::operator()(double value) const {
  const double share = std::isnan(value) ? 1.0 : std::clamp((value - low) / (high - low), 0.0, 1.0);
  return from + share * (to - from);
}

std::vector<double> TicksUpTo(double highest, std::size_t most) {
  const double top = std::isfinite(highest) && highest > 0.0 ? highest : 1.0;
  double step = std::pow(10.0, std::floor(std::log10(top / static_cast<double>(most))));
  for (const double factor : {2.0, 2.5, 2.0}) {
    if (std::ceil(top / step) > static_cast<double>(most)) step *= factor;
  }
  std::vector<double> ticks = {0.0};
  while (ticks.back() < top) ticks.push_back(static_cast<double>(ticks.size()) * step);
  return ticks;
}

double LargestFinite(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  return largest;
}

std::string Pixels(double value) {
  return Fixed(std::isfinite(value) ? value : 0.0, 1);
}

Markup LineShape(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view style) {
  return Element("line", {{"class", std::string(style)},
                          {"x1", Pixels(from.x())},
                          {"y1", Pixels(from.y())},
                          {"x2", Pixels(to.x())},
                          {"y2", Pixels(to.y())}});
}

Markup RectangleShape(const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                      std::string_view style) {
  return Element("rect", {{"class", std::string(style)},
                          {"x", Pixels(corner.x())},
                          {"y", Pixels(corner.y())},
                          {"width", Pixels(std::max(size.x(), 0.0))},
                          {"height", Pixels(std::max(size.y(), 0.0))}});
}

Markup CircleShape(const Eigen::Vector2d& centre, double radius, std::string_view style) {
  return Element("circle", {{"class", std::string(style)},
                            {"cx", Pixels(centre.x())},
                            {"cy", Pixels(centre.y())},
                            {"r", Pixels(radius)}});
}

Markup PathShape(const std::vector<Eigen::Vector2d>& points, std::string_view style) {
  std::string list;
  for (const Eigen::Vector2d& point : points) {
    list.append(list.empty() ? "" : " ").append(Pixels(point.x())).append(",");
    list += Pixels(point.y());
  }
  return Element("polyline", {{"class", std::string(style)}, {"points", list}});
}

Markup Titled(std::string_view text, const Markup& shape) {
  return Element("g", {}, Element("title", {}, Words(text)) + shape);
}

Markup LabelShape(const Eigen::Vector2d& at, std::string_view text, Anchor anchor,
                  std::string_view style) {
  const char* where = anchor == Anchor::kStart ? "start"
                      : anchor == Anchor::kEnd ? "end"
                                               : "middle";
  return Element("text",
                 {{"class", std::string(style)},
                  {"x", Pixels(at.x())},
                  {"y", Pixels(at.y())},
                  {"text-anchor", where}},
                 Words(text));
}

Markup Picture(const Eigen::Vector2d& size, std::string_view style, std::string_view description,
               const Markup& shapes) {
  return Element("svg",
                 {{"class", "picture " + std::string(style)},
                  {"viewBox", "0 0 " + Pixels(size.x()) + ' ' + Pixels(size.y())},
                  {"role", "img"},
                  {"aria-label", std::string(description)}},
                 shapes);
}

}  // namespace telltale
