#include "telltale/core/identification/model_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/estimation/prediction_error/score_covariance.hpp"

namespace telltale {
namespace {

std::optional<Refusal> Unlike(const Identification& first, const Identification& second) {
  std::string what;
  const auto differs = [&](bool difference, const char* name) {
    if (difference) what += (what.empty() ? "" : ", ") + std::string(name);
  };
  differs(first.structure != second.structure, "structure");
  differs(first.parameterization != second.parameterization, "parameterization");
  differs(first.estimator != second.estimator, "estimator");
  differs(std::abs(first.sampling_period_s - second.sampling_period_s) > 1e-9, "sampling period");
  const bool estimates_dead_zone = first.structure == Structure::kFossen;
  differs(!estimates_dead_zone && first.dead_zone != second.dead_zone, "dead zone");
  if (what.empty()) return std::nullopt;
  return Refusal{"comparison", "the models differ in " + what,
                 "identify both with the same options"};
}

// Wind and current, which are no property of the boat.
constexpr std::string_view kSteadyDisturbance = "1";

std::size_t ClustersBehind(const Identification& identification) {
  const Provenance& provenance = identification.provenance;
  if (provenance.clusters > 0) return std::max<std::size_t>(provenance.clusters, 2);
  if (provenance.bootstrap_replicates == 0) return 0;
  return std::max<std::size_t>(
      std::min(identification.window.slices, provenance.bootstrap_replicates), 2);
}

/// Where each coefficient of `order` stands in `model`, -1 where it does not or is not the boat's.
std::vector<Eigen::Index> PlacesIn(const Identification& model, const Identification& order) {
  std::vector<Eigen::Index> places;
  for (const Coefficient& wanted : order.coefficients) {
    const auto found =
        std::find_if(model.coefficients.begin(), model.coefficients.end(), [&](const auto& c) {
          return c.equation == wanted.equation && c.regressor == wanted.regressor &&
                 c.regressor != kSteadyDisturbance;
        });
    places.push_back(found == model.coefficients.end() ? -1 : found - model.coefficients.begin());
  }
  return places;
}

/// Estimates of all coefficients and, in the last place, of the thruster time constant.
struct Stacked {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
};

Stacked Stack(const Identification& model) {
  const auto p = static_cast<Eigen::Index>(model.coefficients.size());
  Stacked stacked{Eigen::VectorXd::Zero(p + 1), Eigen::MatrixXd::Zero(p + 1, p + 1)};
  stacked.theta.head(p) = model.Estimates();
  stacked.covariance.topLeftCorner(p, p) = model.covariance;
  stacked.covariance(p, p) = std::numeric_limits<double>::infinity();
  if (model.thruster_time_constant && model.time_constant_covariance.size() == p) {
    stacked.theta[p] = model.thruster_time_constant->estimate;
    stacked.covariance(p, p) = std::pow(model.thruster_time_constant->standard_error, 2);
    stacked.covariance.row(p).head(p) = model.time_constant_covariance.transpose();
    stacked.covariance.col(p).head(p) = model.time_constant_covariance;
  }
  return stacked;
}

/// The estimates of `model` in the order of `order`, the time constant last; what it lacks has
/// infinite variance.
Estimates InOrderOf(const Identification& order, const Identification& model) {
  const Stacked stacked = Stack(model);
  std::vector<Eigen::Index> places = PlacesIn(model, order);
  places.push_back(stacked.theta.size() - 1);
  const auto p = static_cast<Eigen::Index>(places.size());
  Estimates estimates{Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p), ClustersBehind(model)};
  for (Eigen::Index i = 0; i < p; ++i) {
    const Eigen::Index from = places[static_cast<std::size_t>(i)];
    estimates.covariance(i, i) = std::numeric_limits<double>::infinity();
    if (from < 0) continue;
    estimates.theta[i] = stacked.theta[from];
    for (Eigen::Index j = 0; j < p; ++j) {
      const Eigen::Index to = places[static_cast<std::size_t>(j)];
      if (to >= 0) estimates.covariance(i, j) = stacked.covariance(from, to);
    }
  }
  return estimates;
}

// The delays between the clocks, the last two parameters, are no property of the boat.
constexpr Eigen::Index kBoatParameters = At(FossenParameter::kCommandDelay);

Estimates ParametersOf(const Identification& model) {
  return {model.physical->Estimates().head<kBoatParameters>(),
          model.physical->covariance.topLeftCorner<kBoatParameters, kBoatParameters>(),
          EquivalentBlocks(ClustersBehind(model))};
}

/// What stands at a place of the test's result.
const Coefficient& ComparedIn(const Identification& model, std::size_t place) {
  if (model.physical) return model.physical->parameters[place];
  return place < model.coefficients.size() ? model.coefficients[place]
                                           : *model.thruster_time_constant;
}

}  // namespace

Result<WaldTest> TestForChange(const Identification& first, const Identification& second) {
  if (auto refusal = Unlike(first, second)) return tl::unexpected(*refusal);
  if (first.physical) return TestEquality(ParametersOf(first), ParametersOf(second));
  return TestEquality(InOrderOf(first, first), InOrderOf(first, second));
}

bool AreComparable(const Identification& first, const Identification& second) {
  return !Unlike(first, second);
}

bool WindowsOverlap(const Identification& first, const Identification& second) {
  return first.window.start_s < second.window.end_s && second.window.start_s < first.window.end_s;
}

Result<ModelChange> ChangeBetween(const Identification& earlier, const Identification& later) {
  const auto test = TestForChange(later, earlier);
  if (!test) return tl::unexpected(test.error());
  ModelChange change;
  change.verdict = test->p_value < kSignificantChange ? ChangeVerdict::kChanged
                                                      : ChangeVerdict::kNoSignificantChange;
  change.p_value = test->p_value;
  change.statistic = test->statistic;
  change.degrees_of_freedom = test->degrees_of_freedom;
  for (const CoefficientDifference& d : test->differences) {
    const Coefficient& of = ComparedIn(later, d.index);
    change.coefficients.push_back(
        {of.equation, of.regressor, of.symbol, d.difference, d.standard_error, d.p_value});
  }
  return change;
}

std::string AnswerOf(const ModelChange& change) {
  const std::string p = "p = " + FormatSignificant(change.p_value, 2) + '.';
  switch (change.verdict) {
    case ChangeVerdict::kChanged: return "The models differ, " + p;
    case ChangeVerdict::kNoSignificantChange: return "The models do not differ significantly, " + p;
    case ChangeVerdict::kInconclusive:
      return "The models cannot be compared: " + change.reason + '.';
    case ChangeVerdict::kUnknown: break;
  }
  return "The models were not compared.";
}

}  // namespace telltale
