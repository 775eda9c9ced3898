#pragma once

#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// The identification with a different number in every place of its excitation, advice and
/// coverage check.
inline Identification WithIdentifiability(Identification made) {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  for (const Equation equation : kEquations) {
    ExcitationSummary summary;
    summary.equation = equation;
    summary.condition = 20.0 + static_cast<double>(IndexOf(equation)) / 3.0;
    const std::size_t regressors = Regressors(equation, made.parameterization).size();
    for (std::size_t j = 0; j < regressors; ++j) {
      summary.variance_inflation.push_back(1.0 + static_cast<double>(j) / 7.0);
    }
    summary.variance_inflation[1] = kUnbounded;
    summary.least_separable = {{0, 1.0}, {2, -1.0 / 3.0}};
    summary.rows = 500 + IndexOf(equation);
    summary.effective_rows = 100.0 / 3.0;
    made.excitation.push_back(summary);
  }
  made.advice.push_back({"zigzag",
                         "changing sides every 6 s",
                         120.0,
                         10.0 / 3.0,
                         {{Equation::kYaw, "r|r|", "1", -0.5, 0.2, 0.2 / 3.0},
                          {Equation::kSurge, "vr", "1", 0.0, kUnbounded, 0.125}}});
  made.advice.push_back({"spins", "thrusters against each other", 60.0, 0.0, {}});
  CoverageCheck coverage_check;
  coverage_check.replicates_requested = 100;
  coverage_check.replicates_identified = 98;
  coverage_check.seed = std::numeric_limits<std::uint64_t>::max();
  coverage_check.level = 0.9;
  for (std::size_t i = 0; i < made.coefficients.size(); ++i) {
    coverage_check.coefficients.push_back({{i, 98}, static_cast<double>(i) / 3.0 - 5.0});
  }
  if (made.thruster_time_constant) {
    coverage_check.thruster_time_constant = CoefficientCoverage{{90, 97}, -1.0 / 7.0};
  }
  coverage_check.joint = {88, 96};
  coverage_check.mean_coverage = 0.9375;
  coverage_check.mean_coverage_error = 0.01 / 3.0;
  coverage_check.truth_is_reported_model = true;
  made.coverage_check = coverage_check;
  return made;
}

inline void ExpectSame(const CoefficientCoverage& a, const CoefficientCoverage& b) {
  EXPECT_EQ(a.tally, b.tally);
  EXPECT_EQ(a.bias, b.bias);
}

inline void ExpectSame(const CoverageCheck& a, const CoverageCheck& b) {
  EXPECT_EQ(a.replicates_requested, b.replicates_requested);
  EXPECT_EQ(a.replicates_identified, b.replicates_identified);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.level, b.level);
  ASSERT_EQ(a.coefficients.size(), b.coefficients.size());
  for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
    ExpectSame(a.coefficients[i], b.coefficients[i]);
  }
  ASSERT_EQ(a.thruster_time_constant.has_value(), b.thruster_time_constant.has_value());
  if (a.thruster_time_constant) ExpectSame(*a.thruster_time_constant, *b.thruster_time_constant);
  EXPECT_EQ(a.joint, b.joint);
  EXPECT_EQ(a.mean_coverage, b.mean_coverage);
  EXPECT_EQ(a.mean_coverage_error, b.mean_coverage_error);
  EXPECT_EQ(a.truth_is_reported_model, b.truth_is_reported_model);
}

inline void ExpectSame(const ExcitationSummary& a, const ExcitationSummary& b) {
  EXPECT_EQ(a.equation, b.equation);
  EXPECT_EQ(a.condition, b.condition);
  EXPECT_EQ(a.variance_inflation, b.variance_inflation);
  EXPECT_EQ(a.least_separable, b.least_separable);
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.effective_rows, b.effective_rows);
}

inline void ExpectSame(const ManoeuvreAdvice& a, const ManoeuvreAdvice& b) {
  EXPECT_EQ(a.manoeuvre, b.manoeuvre);
  EXPECT_EQ(a.how, b.how);
  EXPECT_EQ(a.duration_s, b.duration_s);
  EXPECT_EQ(a.expected_nats, b.expected_nats);
  ASSERT_EQ(a.expected.size(), b.expected.size());
  for (std::size_t i = 0; i < a.expected.size(); ++i) {
    EXPECT_EQ(a.expected[i].equation, b.expected[i].equation);
    EXPECT_EQ(a.expected[i].regressor, b.expected[i].regressor);
    EXPECT_EQ(a.expected[i].unit, b.expected[i].unit);
    EXPECT_EQ(a.expected[i].estimate, b.expected[i].estimate);
    EXPECT_EQ(a.expected[i].half_width, b.expected[i].half_width);
    EXPECT_EQ(a.expected[i].expected_half_width, b.expected[i].expected_half_width);
  }
}

/// Excitation, advice and coverage check, bit for bit.
inline void ExpectSameIdentifiability(const Identification& a, const Identification& b) {
  ASSERT_EQ(a.excitation.size(), b.excitation.size());
  for (std::size_t i = 0; i < a.excitation.size(); ++i)
    ExpectSame(a.excitation[i], b.excitation[i]);
  ASSERT_EQ(a.advice.size(), b.advice.size());
  for (std::size_t i = 0; i < a.advice.size(); ++i) ExpectSame(a.advice[i], b.advice[i]);
  ASSERT_EQ(a.coverage_check.has_value(), b.coverage_check.has_value());
  if (a.coverage_check) ExpectSame(*a.coverage_check, *b.coverage_check);
}

}  // namespace telltale
