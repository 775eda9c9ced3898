#include "telltale/core/vessel/vessel_model.hpp"

#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr std::size_t kLongestRow = 16;

double RowTimesTheta(const VesselModel& model, Equation equation, const Nu& nu,
                     const ThrustRegressors& thrust) {
  const Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
  std::array<double, kLongestRow> row{};
  const auto size = Regressors(equation, model.parameterization).size();
  Require(static_cast<std::size_t>(theta.size()) == size, "theta as long as its regressors");
  FillRow(equation, nu, thrust, std::span(row).first(size));
  return Eigen::Map<const Eigen::VectorXd>(row.data(), theta.size()).dot(theta);
}

/// No lag in the static structure.
LagPerPeriod LagOf(const VesselModel& model, double elapsed_s) {
  if (model.structure == Structure::kStaticQuadratic) return {};
  Require(model.thruster_time_constant_s && *model.thruster_time_constant_s > 0.0,
          "a positive thruster time constant in the dynamic structure");
  if (elapsed_s == 0.0) return {1.0, 1.0, 0.0, 0.0};
  return LagOver(*model.thruster_time_constant_s / elapsed_s);
}

ThrustRegressors EachApproaching(const ThrustRegressors& start, const ThrustRegressors& steady,
                                 double share) {
  ThrustRegressors next;
  for (std::size_t i = 0; i < next.surge.size(); ++i) {
    next.surge[i] = Approach(start.surge[i], steady.surge[i], share);
    next.turning[i] = Approach(start.turning[i], steady.turning[i], share);
  }
  return next;
}

}  // namespace

VesselModel VesselModel::OfZeros(Structure structure, Parameterization parameterization,
                                 Discretisation discretisation, double sampling_period_s) {
  VesselModel model;
  model.structure = structure;
  model.parameterization = parameterization;
  model.discretisation = discretisation;
  model.sampling_period_s = sampling_period_s;
  for (const Equation equation : kEquations) {
    const auto size = static_cast<Eigen::Index>(Regressors(equation, parameterization).size());
    model.theta[IndexOf(equation)] = Eigen::VectorXd::Zero(size);
  }
  return model;
}

ThrustRegressors VesselModel::SteadyThrust(const PropellerCommand& delta) const {
  const ThrustRegressors balanced = ThrustOf(parameterization, dead_zone.Apply(delta));
  if (thrust_imbalance == 0.0) return balanced;
  Require(parameterization == Parameterization::kPropeller,
          "a thrust imbalance in the parameterization by propeller");
  // Surge has the sum of both propellers, turning their difference.
  ThrustRegressors thrust;
  for (std::size_t i = 0; i < thrust.surge.size(); ++i) {
    thrust.surge[i] = balanced.surge[i] - thrust_imbalance * balanced.turning[i];
    thrust.turning[i] = balanced.turning[i] - thrust_imbalance * balanced.surge[i];
  }
  return thrust;
}

ThrustRegressors VesselModel::ThrustAfter(const ThrustRegressors& thrust,
                                          const PropellerCommand& delta, double elapsed_s) const {
  return EachApproaching(thrust, SteadyThrust(delta), LagOf(*this, elapsed_s).remaining);
}

ThrustRegressors VesselModel::MeanThrust(const ThrustRegressors& thrust,
                                         const PropellerCommand& delta, double elapsed_s) const {
  return EachApproaching(thrust, SteadyThrust(delta), LagOf(*this, elapsed_s).mean);
}

ThrustRegressors VesselModel::ThrustAt(double u, const ThrustRegressors& thrust) const {
  if (reverse_loss.per_speed == 0.0) return thrust;
  Require(parameterization == Parameterization::kPropeller,
          "a reverse loss in the parameterization by propeller");
  const double share = reverse_loss.Share(u);
  ThrustRegressors at = thrust;
  for (const std::size_t reverse : {2, 3}) {
    at.surge[reverse] *= share;
    at.turning[reverse] *= share;
  }
  return at;
}

NuDot VesselModel::AccelerationUnder(const ThrustRegressors& thrust, const Nu& nu) const {
  const ThrustRegressors left = ThrustAt(nu.u, thrust);
  return {RowTimesTheta(*this, Equation::kSurge, nu, left),
          RowTimesTheta(*this, Equation::kSway, nu, left),
          RowTimesTheta(*this, Equation::kYaw, nu, left)};
}

NuDot VesselModel::Acceleration(const Nu& nu, const PropellerCommand& delta) const {
  return AccelerationUnder(SteadyThrust(delta), nu);
}

}  // namespace telltale
