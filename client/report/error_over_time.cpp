#include <algorithm>

#include "telltale/client/report/diagnosis_text.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/plot.hpp"

namespace telltale {
namespace {

struct TimeFrame {
  Axis x;
  Axis y;
  std::vector<double> x_ticks;
  std::vector<double> y_ticks;
};

TimeFrame FrameOf(const Diagnosis& diagnosis, const Eigen::Vector2d& size) {
  constexpr double kLeft = 38.0;
  constexpr double kRight = 18.0;
  constexpr double kTop = 30.0;
  constexpr double kBottom = 46.0;
  std::vector<double> errors = {diagnosis.Main().all.floor_limit};
  for (const WindowPicture& window : diagnosis.pictures) {
    errors.insert(errors.end(), {window.before, window.after});
  }
  const double span_s = std::max(diagnosis.end_s - diagnosis.start_s, 1.0);
  TimeFrame frame;
  frame.y_ticks = TicksUpTo(LargestFinite(errors), 5);
  frame.x_ticks = TicksUpTo(span_s, size.x() > 600.0 ? 10 : 4);
  frame.x = {0.0, span_s, kLeft, size.x() - kRight};
  frame.y = {0.0, frame.y_ticks.back(), size.y() - kBottom, kTop};
  return frame;
}

Markup GridOf(const TimeFrame& frame) {
  Markup grid;
  for (const double error : frame.y_ticks) {
    const double y = frame.y(error);
    grid += LineShape({frame.x.from, y}, {frame.x.to, y}, "grid");
    grid += LabelShape({frame.x.from - 8.0, y + 5.0}, Plain(error), Anchor::kEnd);
  }
  for (const double time_s : frame.x_ticks) {
    if (time_s > frame.x.high) continue;
    grid += LabelShape({frame.x(time_s), frame.y.from + 20.0}, Plain(time_s), Anchor::kMiddle);
  }
  grid += LabelShape({4.0, 16.0}, "error, times the normal error", Anchor::kStart);
  grid += LabelShape({frame.x.to, frame.y.from + 40.0}, "seconds since the start", Anchor::kEnd);
  return grid;
}

Markup NoiseFloorBand(const TimeFrame& frame, const GapSize& gap) {
  const double limit = frame.y(gap.floor_limit);
  const double floor = frame.y(gap.noise_floor);
  return RectangleShape({frame.x.from, limit}, {frame.x.to - frame.x.from, frame.y.from - limit},
                        "floor-band") +
         LineShape({frame.x.from, floor}, {frame.x.to, floor}, "floor-line");
}

Markup OnsetOf(const TimeFrame& frame, const Diagnosis& diagnosis) {
  if (!diagnosis.onset) return {};
  const double earliest = frame.x(diagnosis.onset->earliest_s - diagnosis.start_s);
  const double latest = frame.x(diagnosis.onset->latest_s - diagnosis.start_s);
  const double onset = frame.x(diagnosis.onset->time_s - diagnosis.start_s);
  const bool right = onset > 0.75 * frame.x.to;
  return RectangleShape({earliest, frame.y.to}, {latest - earliest, frame.y.from - frame.y.to},
                        "onset-band") +
         LineShape({onset, frame.y.to}, {onset, frame.y.from}, "onset-line") +
         LabelShape({onset + (right ? -6.0 : 6.0), frame.y.to - 2.0}, "onset",
                    right ? Anchor::kEnd : Anchor::kStart, "strong");
}

/// Dots where there is room for them, else the line alone.
Markup CurveOf(const TimeFrame& frame, const Diagnosis& diagnosis, double WindowPicture::*error,
               const std::string& name) {
  constexpr double kRoomForDots = 6.0;  // pixels
  constexpr double kDotRadius = 2.75;
  std::vector<Eigen::Vector2d> points;
  Markup dots;
  for (const WindowPicture& window : diagnosis.pictures) {
    points.emplace_back(frame.x(window.time_s - diagnosis.start_s), frame.y(window.*error));
    dots += CircleShape(points.back(), kDotRadius, name + "-dot");
  }
  const double spacing = (frame.x.to - frame.x.from) / static_cast<double>(points.size());
  if (spacing < kRoomForDots) return PathShape(points, name + "-trace dense");
  return PathShape(points, name + "-trace") + dots;
}

/// A column a window, over which a pointer shows its time and errors.
Markup ColumnsOf(const TimeFrame& frame, const Diagnosis& diagnosis) {
  const double width = (frame.x.to - frame.x.from) / static_cast<double>(diagnosis.pictures.size());
  const bool after = HasAfter(diagnosis);
  Markup columns;
  for (const WindowPicture& window : diagnosis.pictures) {
    const double time_s = window.time_s - diagnosis.start_s;
    const std::string text = Fixed(time_s, 0) + " s: " + Fixed(window.before, 1) +
                             (after ? " before, " + Fixed(window.after, 1) + " after" : "") +
                             ", times the normal error";
    columns += Titled(text, RectangleShape({frame.x(time_s) - 0.5 * width, frame.y.to},
                                           {width, frame.y.from - frame.y.to}, "pointed"));
  }
  return columns;
}

Markup TimePicture(const Diagnosis& diagnosis, const Eigen::Vector2d& size,
                   std::string_view style) {
  const TimeFrame frame = FrameOf(diagnosis, size);
  Markup shapes = NoiseFloorBand(frame, diagnosis.Main().all) + GridOf(frame) +
                  OnsetOf(frame, diagnosis) +
                  CurveOf(frame, diagnosis, &WindowPicture::before, "before");
  if (HasAfter(diagnosis)) {
    shapes += CurveOf(frame, diagnosis, &WindowPicture::after, "after");
  }
  shapes += ColumnsOf(frame, diagnosis);
  const std::string description =
      "Error of each of " + Counted(diagnosis.pictures.size(), "window", "windows") +
      " over time against the floor of " + Fixed(diagnosis.Main().all.noise_floor, 2) +
      " times the normal error." +
      (diagnosis.onset ? ' ' + OnsetText(*diagnosis.onset, diagnosis.start_s) : "");
  return Picture(size, style, description, shapes);
}

}  // namespace

Markup ErrorOverTime(const Diagnosis& diagnosis) {
  if (diagnosis.pictures.empty()) return Nothing("No windows were kept to draw over time.");
  const Eigen::Vector2d wide{940.0, 300.0};
  const Eigen::Vector2d medium{640.0, 290.0};
  const Eigen::Vector2d narrow{312.0, 260.0};
  return Legend(diagnosis, false) + TimePicture(diagnosis, wide, "wide") +
         TimePicture(diagnosis, medium, "medium") + TimePicture(diagnosis, narrow, "narrow");
}

}  // namespace telltale
