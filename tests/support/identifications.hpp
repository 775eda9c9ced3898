#pragma once

#include <limits>

#include "identification/identification.hpp"

namespace telltale {

/// A complete identification with a different number in every place, one coefficient not excited
/// and one refusal: made up, for what carries identifications rather than computes them.
inline Identification MadeUpIdentification(
    Parameterization parameterization = Parameterization::kPropeller) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Identification made;
  made.vehicle_id = "made-up.1";
  made.structure = Structure::kStaticQuadratic;
  made.parameterization = parameterization;
  made.estimator = Estimator::kOneStep;
  made.sampling_period_s = 0.2;
  for (const Equation equation : kEquations) {
    for (const Regressor& regressor : Regressors(equation, parameterization)) {
      const double n = static_cast<double>(made.coefficients.size()) + 1.0;
      made.coefficients.push_back({equation,
                                   std::string(regressor.name),
                                   std::string(regressor.symbol),
                                   -1.0 / (3.0 * n),
                                   0.1 / n,
                                   {0.95, -1.0 / n, 1.0 / (7.0 * n)},
                                   std::string(regressor.unit),
                                   CoefficientStatus::kEstimated});
    }
  }
  const auto n = static_cast<Eigen::Index>(made.coefficients.size());
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n, [](Eigen::Index row, Eigen::Index column) {
        return 1.0 / static_cast<double>(1 + row + 2 * column);
      });
  made.covariance = root * root.transpose();
  Coefficient& still = made.coefficients[1];
  still = {still.equation, still.regressor,
           still.symbol,   0.0,
           kInfinity,      {0.95, -kInfinity, kInfinity},
           still.unit,     CoefficientStatus::kNotExcited};
  made.covariance.row(1).setZero();
  made.covariance.col(1).setZero();
  made.covariance(1, 1) = kInfinity;
  made.covariance = made.covariance.selfadjointView<Eigen::Lower>();
  made.dead_zone = {0.05, -0.0625};
  made.window.start_s = 1700000000.125;
  made.window.end_s = 1700000600.625;
  made.window.samples = 3003;
  made.window.segments = 41;
  made.window.rejected.Count(Channel::kGnss, RejectReason::kDuplicate, 7);
  made.window.rejected.Count(Channel::kThrusters, RejectReason::kNotFinite, 2);
  made.refusals.push_back({"sway", "v and v|v| move together", "add a zigzag at two speeds"});
  made.provenance = {"ROBUST", "a cluster bootstrap over segments",       1000,
                     3,        std::numeric_limits<std::uint64_t>::max(), "0.1.0"};
  return made;
}

/// The same with lagging thrusters.
inline Identification MadeUpDynamicIdentification() {
  Identification made = MadeUpIdentification();
  made.structure = Structure::kFirstOrderDynamic;
  made.thruster_time_constant =
      Coefficient{Equation::kUnknown,           "", "tau", 0.25, 0.0125, {0.95, 0.23, 0.27}, "s",
                  CoefficientStatus::kEstimated};
  return made;
}

}  // namespace telltale
