#pragma once

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/special_values.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

inline ModelChange MadeUpChange() {
  return {3,
          ChangeVerdict::kChanged,
          0.0021,
          71.5,
          32,
          {{Equation::kYaw, "r|r|", "Pr33", 0.051, 0.015, 0.0007},
           {Equation::kUnknown, "", "tau", -0.2, 0.1, 0.046}},
          ""};
}

/// A complete identification with a different number in every place, one coefficient not excited
/// and one refusal: made up, for what carries identifications rather than computes them.
inline Identification MadeUpIdentification(
    Parameterization parameterization = Parameterization::kPropeller) {
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
  made.joint = JointBounds{1.0 / 0.7, 66.0};
  made.dead_zone = {0.05, -0.0625};
  for (const double start_s : {1700000000.125, 1700000400.5}) {
    made.recording_bias.push_back({start_s, start_s + 200.125, {made.coefficients[4]}});
    made.recording_bias.back().coefficients[0].regressor = "cos(psi)";
  }
  made.window.start_s = 1700000000.125;
  made.window.end_s = 1700000600.625;
  made.window.samples = 3003;
  made.window.segments = 3;
  made.window.slices = 41;
  made.window.rejected.Count(Channel::kGnss, RejectReason::kDuplicate, 7);
  made.window.rejected.Count(Channel::kThrusters, RejectReason::kNotFinite, 2);
  made.refusals.push_back({"sway", "v and v|v| move together", "add a zigzag at two speeds"});
  made.disturbance = Disturbance{{0.03, 0.04, 0.05}, {2.0, 3.0, 4.0}, 0.06};
  made.provenance.preset = "ROBUST";
  made.provenance.bounds_basis = "a cluster bootstrap over segments";
  made.provenance.bootstrap_replicates = 1000;
  made.provenance.bootstrap_failures = 3;
  made.provenance.seed = std::numeric_limits<std::uint64_t>::max();
  made.provenance.software_version = "0.2.0";
  made.provenance.parametric_replicates = 40;
  made.provenance.parametric_replicate_failures = 2;
  made.provenance.estimator_choice = "the boat lay in a harbour";
  made.provenance.misspecification = 1.125;
  made.provenance.clusters = 67;
  made.provenance.change = MadeUpChange();
  return made;
}

/// The same with lagging thrusters.
inline Identification MadeUpDynamicIdentification() {
  Identification made = MadeUpIdentification();
  made.structure = Structure::kFirstOrderDynamic;
  made.thruster_time_constant =
      Coefficient{Equation::kUnknown,           "", "tau", 0.25, 0.0125, {0.95, 0.23, 0.27}, "s",
                  CoefficientStatus::kEstimated};
  // A correlation of 1/2 with the first coefficient, and with the others through that one.
  made.time_constant_covariance =
      0.5 * 0.0125 / std::sqrt(made.covariance(0, 0)) * made.covariance.col(0);
  return made;
}

/// The physical form, a different number in every place, one parameter left to its prior.
inline Identification MadeUpPhysicalIdentification() {
  Identification made = MadeUpDynamicIdentification();
  made.structure = Structure::kFossen;
  made.provenance.structure_choice = "the recording is short";
  made.estimator = Estimator::kPredictionError;
  PhysicalModel physical;
  for (std::size_t i = 0; i < kFossenParameters; ++i) {
    const double n = static_cast<double>(i) + 1.0;
    const FossenParameterName& name = FossenParameterNames()[i];
    physical.parameters.push_back({Equation::kUnknown,
                                   "",
                                   std::string(name.symbol),
                                   1.0 / (3.0 * n),
                                   0.1 / n,
                                   {0.95, 0.25 / n, 0.5 / n},
                                   std::string(name.unit),
                                   CoefficientStatus::kEstimated});
  }
  physical.parameters[At(FossenParameter::kM23)].status = CoefficientStatus::kPrior;
  constexpr auto kSize = static_cast<Eigen::Index>(kFossenParameters);
  physical.covariance =
      Eigen::MatrixXd::NullaryExpr(kSize, kSize, [](Eigen::Index row, Eigen::Index column) {
        return 1.0 / static_cast<double>(3 + row + column);
      });
  physical.propeller_separation_m = 0.57;
  physical.noise = {{0.01, 0.02, 0.03}, 2.5, 0.15, 0.06, 0.02, 0.03};
  made.physical = physical;
  return made;
}

/// The same, with half of each estimate for simulation.
inline Identification MadeUpIdentificationWithSimulationParameters() {
  Identification made = MadeUpIdentification();
  for (const Coefficient& c : made.coefficients) made.simulation.push_back(0.5 * c.estimate);
  return made;
}

/// Propeller coefficients by hand, the body's all 7 so that a wrong place shows: forward 2 d^2 + 3
/// d, reverse -4 d^2 + 5 d in surge; half of it in sway, twice of it in yaw. Unit variances, no
/// dead zone.
inline Identification IdentificationByHand() {
  Identification made = MadeUpIdentification();
  made.dead_zone = {};
  std::size_t next = 0;
  for (const Equation equation : kEquations) {
    const double share = equation == Equation::kSurge  ? 1.0
                         : equation == Equation::kSway ? 0.5
                                                       : 2.0;
    const std::array<double, 4> thrust{2.0, 3.0, -4.0, 5.0};
    const std::size_t body = BodyRegressors(equation);
    for (std::size_t i = 0; i < body + 4; ++i, ++next) {
      Coefficient& c = made.coefficients[next];
      c.estimate = i < body ? 7.0 : share * thrust[i - body];
      c.status = CoefficientStatus::kEstimated;
    }
  }
  const auto n = static_cast<Eigen::Index>(made.coefficients.size());
  made.covariance = Eigen::MatrixXd::Identity(n, n);
  return made;
}

// ---- every number, bit for bit ------------------------------------------------------------------

inline void ExpectSame(const Coefficient& a, const Coefficient& b) {
  EXPECT_EQ(a.equation, b.equation);
  EXPECT_EQ(a.regressor, b.regressor);
  EXPECT_EQ(a.symbol, b.symbol);
  EXPECT_EQ(a.estimate, b.estimate);
  EXPECT_EQ(a.standard_error, b.standard_error);
  EXPECT_EQ(a.interval.level, b.interval.level);
  EXPECT_EQ(a.interval.lower, b.interval.lower);
  EXPECT_EQ(a.interval.upper, b.interval.upper);
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.status, b.status);
}

inline void ExpectSame(const WindowSummary& a, const WindowSummary& b) {
  EXPECT_EQ(a.start_s, b.start_s);
  EXPECT_EQ(a.end_s, b.end_s);
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.slices, b.slices);
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      EXPECT_EQ(a.rejected.Of(channel, reason), b.rejected.Of(channel, reason));
    }
  }
}

inline void ExpectSame(const ModelChange& a, const ModelChange& b) {
  EXPECT_EQ(a.revision, b.revision);
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.p_value, b.p_value);
  EXPECT_EQ(a.statistic, b.statistic);
  EXPECT_EQ(a.degrees_of_freedom, b.degrees_of_freedom);
  EXPECT_EQ(a.reason, b.reason);
  ASSERT_EQ(a.coefficients.size(), b.coefficients.size());
  for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
    EXPECT_EQ(a.coefficients[i].equation, b.coefficients[i].equation);
    EXPECT_EQ(a.coefficients[i].regressor, b.coefficients[i].regressor);
    EXPECT_EQ(a.coefficients[i].symbol, b.coefficients[i].symbol);
    EXPECT_EQ(a.coefficients[i].difference, b.coefficients[i].difference);
    EXPECT_EQ(a.coefficients[i].standard_error, b.coefficients[i].standard_error);
    EXPECT_EQ(a.coefficients[i].p_value, b.coefficients[i].p_value);
  }
}

inline void ExpectSame(const Provenance& a, const Provenance& b) {
  EXPECT_EQ(a.preset, b.preset);
  EXPECT_EQ(a.bounds_basis, b.bounds_basis);
  EXPECT_EQ(a.bootstrap_replicates, b.bootstrap_replicates);
  EXPECT_EQ(a.bootstrap_failures, b.bootstrap_failures);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.software_version, b.software_version);
  EXPECT_EQ(a.parametric_replicates, b.parametric_replicates);
  EXPECT_EQ(a.parametric_replicate_failures, b.parametric_replicate_failures);
  EXPECT_EQ(a.structure_choice, b.structure_choice);
  EXPECT_EQ(a.estimator_choice, b.estimator_choice);
  EXPECT_EQ(a.misspecification, b.misspecification);
  EXPECT_EQ(a.clusters, b.clusters);
  ASSERT_EQ(a.change.has_value(), b.change.has_value());
  if (a.change) ExpectSame(*a.change, *b.change);
}

inline void ExpectSame(const PhysicalModel& a, const PhysicalModel& b) {
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    ExpectSame(a.parameters[i], b.parameters[i]);
  }
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.propeller_separation_m, b.propeller_separation_m);
  EXPECT_EQ(a.noise.acceleration_sigma, b.noise.acceleration_sigma);
  EXPECT_EQ(a.noise.acceleration_time_constant_s, b.noise.acceleration_time_constant_s);
  EXPECT_EQ(a.noise.fix_drift_sigma_m, b.noise.fix_drift_sigma_m);
  EXPECT_EQ(a.noise.fix_sigma_m, b.noise.fix_sigma_m);
  EXPECT_EQ(a.noise.heading_sigma_rad, b.noise.heading_sigma_rad);
  EXPECT_EQ(a.noise.stamp_sigma_s, b.noise.stamp_sigma_s);
}

inline void ExpectSame(const Identification& a, const Identification& b) {
  EXPECT_EQ(a.vehicle_id, b.vehicle_id);
  EXPECT_EQ(a.structure, b.structure);
  EXPECT_EQ(a.parameterization, b.parameterization);
  EXPECT_EQ(a.estimator, b.estimator);
  EXPECT_EQ(a.sampling_period_s, b.sampling_period_s);
  ASSERT_EQ(a.coefficients.size(), b.coefficients.size());
  for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
    ExpectSame(a.coefficients[i], b.coefficients[i]);
  }
  EXPECT_EQ(a.dead_zone, b.dead_zone);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.joint, b.joint);
  EXPECT_EQ(a.simulation, b.simulation);
  ASSERT_EQ(a.thruster_time_constant.has_value(), b.thruster_time_constant.has_value());
  if (a.thruster_time_constant) ExpectSame(*a.thruster_time_constant, *b.thruster_time_constant);
  EXPECT_EQ(a.time_constant_covariance, b.time_constant_covariance);
  ASSERT_EQ(a.disturbance.has_value(), b.disturbance.has_value());
  if (a.disturbance) {
    EXPECT_EQ(a.disturbance->sigma, b.disturbance->sigma);
    EXPECT_EQ(a.disturbance->time_constant_s, b.disturbance->time_constant_s);
    EXPECT_EQ(a.disturbance->gnss_drift_m, b.disturbance->gnss_drift_m);
  }
  ASSERT_EQ(a.recording_bias.size(), b.recording_bias.size());
  for (std::size_t i = 0; i < a.recording_bias.size(); ++i) {
    EXPECT_EQ(a.recording_bias[i].start_s, b.recording_bias[i].start_s);
    EXPECT_EQ(a.recording_bias[i].end_s, b.recording_bias[i].end_s);
    ASSERT_EQ(a.recording_bias[i].coefficients.size(), b.recording_bias[i].coefficients.size());
    for (std::size_t j = 0; j < a.recording_bias[i].coefficients.size(); ++j) {
      ExpectSame(a.recording_bias[i].coefficients[j], b.recording_bias[i].coefficients[j]);
    }
  }
  ASSERT_EQ(a.physical.has_value(), b.physical.has_value());
  if (a.physical) ExpectSame(*a.physical, *b.physical);
  ExpectSame(a.window, b.window);
  EXPECT_EQ(a.refusals, b.refusals);
  ExpectSame(a.provenance, b.provenance);
}

}  // namespace telltale
