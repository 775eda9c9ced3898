#include "vessel/vessel_model.hpp"

#include <cmath>

#include "contract.hpp"

namespace telltale {
namespace {

constexpr std::size_t kLongestRow = 16;

double RowTimesTheta(const VesselModel& model, Equation equation, const Nu& nu,
                     const ThrustRegressors& thrust) {
  const Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
  std::array<double, kLongestRow> row;
  const auto size = Regressors(equation, model.parameterization).size();
  Require(static_cast<std::size_t>(theta.size()) == size, "theta as long as its regressors");
  FillRow(equation, nu, thrust, std::span(row).first(size));
  return Eigen::Map<const Eigen::VectorXd>(row.data(), theta.size()).dot(theta);
}

double Decay(double elapsed_s, double time_constant_s) {
  Require(time_constant_s > 0.0, "a positive thruster time constant");
  return std::exp(-elapsed_s / time_constant_s);
}

}  // namespace

ThrustRegressors VesselModel::SteadyThrust(const PropellerCommand& delta) const {
  return ThrustOf(parameterization, dead_zone.Apply(delta));
}

ThrustRegressors VesselModel::ThrustAfter(const ThrustRegressors& thrust,
                                          const PropellerCommand& delta, double elapsed_s) const {
  ThrustRegressors next = SteadyThrust(delta);
  if (structure == Structure::kStaticQuadratic) return next;
  Require(thruster_time_constant_s.has_value(), "a time constant in the dynamic structure");
  const double remaining = Decay(elapsed_s, *thruster_time_constant_s);
  for (std::size_t i = 0; i < next.surge.size(); ++i) {
    next.surge[i] += remaining * (thrust.surge[i] - next.surge[i]);
    next.turning[i] += remaining * (thrust.turning[i] - next.turning[i]);
  }
  return next;
}

NuDot VesselModel::AccelerationUnder(const ThrustRegressors& thrust, const Nu& nu) const {
  return {RowTimesTheta(*this, Equation::kSurge, nu, thrust),
          RowTimesTheta(*this, Equation::kSway, nu, thrust),
          RowTimesTheta(*this, Equation::kYaw, nu, thrust)};
}

NuDot VesselModel::Acceleration(const Nu& nu, const PropellerCommand& delta) const {
  return AccelerationUnder(SteadyThrust(delta), nu);
}

}  // namespace telltale
