#include "fit/unknown_odds.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace blind::fit {
namespace {

using score::Cause;
using score::Report;
using score::Scored;

constexpr const char* kConstant = "constant";

bool IsWeather(const std::string& effect) {
  return effect == "wind" || effect == "current" || effect == "waves";
}

double Logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

/// The report without the unknown cause; nothing where it sees no gap or names nothing else.
std::vector<Cause> NamedCauses(const Report& report) {
  std::vector<Cause> named;
  if (!score::FirstCause(report)) return named;
  std::ranges::copy_if(report.causes, std::back_inserter(named),
                       [](const Cause& cause) { return !score::IsUnknown(cause); });
  return named;
}

Observation Likeliest(const Report& report, const Cause& cause) {
  return {.regressors = report.unknown_regressors,
          .is_weather = std::ranges::all_of(cause.effects, IsWeather)};
}

bool IsTheCause(const Scored& scored, std::vector<Cause> named) {
  if (scored.label.kind == "outside") return false;
  Scored known = scored;
  known.report.causes = std::move(named);
  return score::ClassHit(known);
}

void AddObservations(const Scored& scored, std::vector<Observation>& observations) {
  if (const auto named = NamedCauses(scored.report); !named.empty()) {
    Observation seen = Likeliest(scored.report, named.front());
    seen.is_another = !IsTheCause(scored, named);
    observations.push_back(std::move(seen));
  }
  if (!scored.left_out) return;
  const auto named = NamedCauses(*scored.left_out);
  if (named.empty() || score::IsWeatherThatIsThere(&named.front(), scored.label) ||
      score::IsConfusable(named.front(), scored.label.effects)) {
    return;
  }
  Observation seen = Likeliest(*scored.left_out, named.front());
  seen.is_another = true;
  seen.is_left_out = true;
  observations.push_back(std::move(seen));
}

double RegressorOf(const Observation& observation, const std::string& name) {
  const auto found = observation.regressors.find(name);
  if (found == observation.regressors.end()) {
    throw std::invalid_argument("a report has no odds of an unknown cause by " + name);
  }
  return found->second;
}

/// One row an observation, one column a regressor; outcomes of 1 where the cause is another.
struct Regression {
  Eigen::MatrixXd regressors;
  Eigen::VectorXd outcomes;
  Eigen::VectorXd ridge;  ///< times the square of each weight
};

Regression RegressionOf(const std::vector<Observation>& observations,
                        const std::vector<std::string>& names, double ridge) {
  const auto columns = static_cast<Eigen::Index>(names.size());
  Regression regression;
  regression.regressors.resize(std::ssize(observations), columns);
  regression.outcomes.resize(std::ssize(observations));
  regression.ridge = Eigen::VectorXd::Constant(columns, ridge);
  Eigen::Index i = 0;
  for (const Observation& observation : observations) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      regression.regressors(i, j) = RegressorOf(observation, names[static_cast<std::size_t>(j)]);
    }
    regression.outcomes[i++] = observation.is_another ? 1.0 : 0.0;
  }
  for (Eigen::Index j = 0; j < columns; ++j) {
    if (names[static_cast<std::size_t>(j)] == kConstant) regression.ridge[j] = 0.0;
  }
  return regression;
}

/// Newton's step down the loss.
Eigen::VectorXd StepFrom(const Eigen::VectorXd& weights, const Regression& given) {
  const double count = static_cast<double>(given.outcomes.size());
  const Eigen::VectorXd expected = (given.regressors * weights).unaryExpr(&Logistic);
  const Eigen::VectorXd variances = expected.array() * (1.0 - expected.array());
  Eigen::MatrixXd curvature =
      given.regressors.transpose() * variances.asDiagonal() * given.regressors / count;
  curvature.diagonal() += 2.0 * given.ridge;
  const Eigen::VectorXd gradient =
      given.regressors.transpose() * (expected - given.outcomes) / count +
      2.0 * given.ridge.cwiseProduct(weights);
  return -curvature.ldlt().solve(gradient);
}

/// The loss is convex. Steps no longer than one do not pass its minimum by far.
Eigen::VectorXd LikeliestWeights(const Regression& given) {
  constexpr int kMost = 200;
  constexpr double kSettled = 1e-9;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(given.regressors.cols());
  for (int iteration = 0; iteration < kMost; ++iteration) {
    Eigen::VectorXd step = StepFrom(weights, given);
    step *= std::min(1.0, 1.0 / step.norm());
    weights += step;
    if (step.norm() <= kSettled) return weights;
  }
  throw std::invalid_argument("the odds have no weights without a ridge");
}

}  // namespace

std::vector<Observation> ObservationsOf(const std::vector<Scored>& cases) {
  std::vector<Observation> observations;
  for (const Scored& scored : cases) AddObservations(scored, observations);
  return observations;
}

double LogisticModel::Probability(const Observation& observation) const {
  double log_odds = 0.0;
  for (const auto& [name, weight] : weights) log_odds += weight * RegressorOf(observation, name);
  return Logistic(log_odds);
}

LogisticModel FitLogistic(const std::vector<Observation>& observations,
                          const std::vector<std::string>& names, double ridge) {
  const auto others = std::ranges::count_if(observations, &Observation::is_another);
  if (others == 0 || others == std::ssize(observations)) {
    throw std::invalid_argument("odds take causes that are the likeliest one, and others");
  }
  const Eigen::VectorXd weights = LikeliestWeights(RegressionOf(observations, names, ridge));
  LogisticModel model;
  for (std::size_t j = 0; j < names.size(); ++j) {
    model.weights[names[j]] = weights[static_cast<Eigen::Index>(j)];
  }
  return model;
}

double LogarithmicLoss(const LogisticModel& model, const std::vector<Observation>& observations) {
  std::vector<double> losses;
  for (const Observation& observation : observations) {
    const double another = model.Probability(observation);
    losses.push_back(-std::log(observation.is_another ? another : 1.0 - another));
  }
  return score::Mean(losses);
}

}  // namespace blind::fit
