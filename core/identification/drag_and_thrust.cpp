#include "telltale/core/identification/drag_and_thrust.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telltale/core/identification/implied_covariance.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

constexpr double kHalf = 0.5;
constexpr double kFull = 1.0;
constexpr double kAcross = 0.1;  // of the top speed
// A boat without any drag has no top speed.
constexpr double kLeastDrag = 1e-6;

double DragAhead(const FossenVector& p, double u) {
  return (p[At(kXu)] + p[At(kXuu)] * u) * u;
}

double DragAcross(const FossenVector& p, double v) {
  return (p[At(kYv)] + p[At(kYvv)] * v) * v;
}

double DampingInYaw(const FossenVector& p, double r) {
  return (p[At(kNr)] + p[At(kNrr)] * r) * r;
}

// The speed at which (linear + quadratic x) x is the force.
double SpeedOf(double force, double linear, double quadratic) {
  const double root = std::sqrt(linear * linear + 4.0 * std::max(quadratic, kLeastDrag) * force);
  return 2.0 * force / (linear + root);
}

double TopSpeed(const FossenVector& p) {
  return SpeedOf(2.0 * ForwardThrust(p, kFull), p[At(kXu)], p[At(kXuu)]);
}

double RateOfTurn(const FossenVector& p, double separation_m) {
  const double moment = 0.5 * separation_m * (ForwardThrust(p, kFull) + ReverseThrust(p, kFull));
  return SpeedOf(moment, p[At(kNr)], p[At(kNrr)]);
}

// Name, point and units, without values.
std::vector<ForceAtPoint> PointsOf(const FossenVector& p, double separation_m) {
  const double top_speed = TopSpeed(p);
  const double rate_of_turn = RateOfTurn(p, separation_m);
  const auto point = [](std::string name, double at, std::string at_unit, std::string unit) {
    return ForceAtPoint{std::move(name), at, std::move(at_unit), 0.0, {}, std::move(unit)};
  };
  return {point("top speed", kFull, "1", "m/s"),
          point("rate of turn", kFull, "1", "rad/s"),
          point("drag ahead", kHalf * top_speed, "m/s", "m/s^2"),
          point("drag across", kAcross * top_speed, "m/s", "m/s^2"),
          point("damping in yaw", kHalf * rate_of_turn, "rad/s", "m^2/s^2"),
          point("forward thrust", kHalf, "1", "m/s^2"),
          point("forward thrust", kFull, "1", "m/s^2"),
          point("reverse thrust", kHalf, "1", "m/s^2"),
          point("reverse thrust", kFull, "1", "m/s^2")};
}

}  // namespace

Eigen::VectorXd ForcesAt(const std::vector<ForceAtPoint>& points, const FossenVector& parameters,
                         double separation_m) {
  Eigen::VectorXd forces(std::ssize(points));
  const auto at = [&](Eigen::Index i) { return points[static_cast<std::size_t>(i)].at; };
  forces << TopSpeed(parameters), RateOfTurn(parameters, separation_m),
      DragAhead(parameters, at(2)), DragAcross(parameters, at(3)), DampingInYaw(parameters, at(4)),
      ForwardThrust(parameters, at(5)), ForwardThrust(parameters, at(6)),
      ReverseThrust(parameters, at(7)), ReverseThrust(parameters, at(8));
  return forces;
}

std::vector<ForceAtPoint> DragAndThrustOf(const PhysicalModel& physical) {
  const double separation_m = physical.propeller_separation_m;
  const FossenVector estimates = physical.Estimates();
  std::vector<ForceAtPoint> points = PointsOf(estimates, separation_m);
  const Eigen::VectorXd values = ForcesAt(points, estimates, separation_m);
  const Eigen::VectorXd variances =
      ImpliedCovariance(estimates, physical.covariance,
                        [&](const FossenVector& parameters) {
                          return ForcesAt(points, parameters, separation_m);
                        })
          .diagonal()
          .cwiseMax(0.0);
  const double level = physical.parameters.front().interval.level;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    ForceAtPoint& point = points[static_cast<std::size_t>(i)];
    point.estimate = values[i];
    point.interval = NormalInterval(values[i], std::sqrt(variances[i]), level);
    point.interval.lower = std::max(point.interval.lower, 0.0);
  }
  return points;
}

}  // namespace telltale
