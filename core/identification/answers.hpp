#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimation/excitation.hpp"
#include "estimation/one_step.hpp"
#include "identification/identification.hpp"
#include "result.hpp"
#include "uncertainty/interval.hpp"

namespace telltale {

/// The thrusters' lag as one of the answers.
struct AnsweredLag {
  double time_constant_s = 0.0;
  bool no_lag_seen = false;  ///< the data bound it from above alone
};

/// Rows, or windows, behind an equation's estimate.
struct SampleSize {
  std::size_t rows = 0;
  double effective_rows = 0.0;
};

/// Everything known about the equations before coefficients are written down. The stacked unknowns
/// are the time constant, if there is a lag, and then the coefficients of each answered equation,
/// which begin at first[j].
struct Answers {
  std::array<std::optional<Excitation>, 3> excitations;
  std::array<std::optional<EquationEstimate>, 3> estimates;
  std::array<Eigen::Index, 3> first{};
  std::array<SampleSize, 3> sizes{};
  std::optional<AnsweredLag> lag;
  std::vector<Refusal> refusals;

  bool Any() const {
    return std::any_of(excitations.begin(), excitations.end(), [](const auto& e) { return e; });
  }
};

/// Bounds of all stacked unknowns.
struct Bounds {
  double degrees_of_freedom = 0.0;
  Eigen::MatrixXd covariance;
  std::vector<Interval> intervals;
  std::vector<bool> estimable;
};

/// What an estimator makes of a dataset: answers, their bounds and what those rest on.
struct BoundedAnswers {
  Answers answers;
  Bounds bounds;
  Provenance provenance;  ///< the fields that are the estimator's
  std::optional<Disturbance> disturbance;
};

/// Can this equation be answered? Its excitation or a refusal goes into the answers.
void AssessEquation(const EquationProblem& regression, const ExcitationLimits& limits,
                    Answers& answers);

/// Refuses for all equations at once.
Refusal NothingAnswered(const std::vector<Refusal>& refusals);

/// The sample size behind residuals whose places in time follow each other at `stride`.
SampleSize SizeOf(const Eigen::VectorXd& residual, std::span<const std::size_t> places,
                  std::size_t stride);

/// What the data show of each answered equation.
std::vector<ExcitationSummary> Summarise(const Answers& answers, Parameterization parameterization);

/// Coefficients, covariance and time constant, in the order and with the places of Identification.
void WriteCoefficients(const Answers& answers, const Bounds& bounds,
                       Identification& identification);

}  // namespace telltale
