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
using score::Label;
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

/// Curvature and gradient of the loss.
struct Quadratic {
  Eigen::MatrixXd curvature;
  Eigen::VectorXd gradient;
};

Quadratic QuadraticAt(const Eigen::VectorXd& weights, const Eigen::MatrixXd& regressors,
                      const Eigen::VectorXd& outcomes, const Eigen::VectorXd& ridge) {
  const double count = static_cast<double>(outcomes.size());
  const Eigen::VectorXd expected = (regressors * weights).unaryExpr(&Logistic);
  const Eigen::VectorXd variances = expected.array() * (1.0 - expected.array());
  Quadratic loss;
  loss.curvature = regressors.transpose() * variances.asDiagonal() * regressors / count;
  loss.curvature.diagonal() += 2.0 * ridge;
  loss.gradient =
      regressors.transpose() * (expected - outcomes) / count + 2.0 * ridge.cwiseProduct(weights);
  return loss;
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
  const auto rows = static_cast<Eigen::Index>(observations.size());
  const auto columns = static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd regressors(rows, columns);
  Eigen::VectorXd outcomes(rows);
  Eigen::VectorXd ridges = Eigen::VectorXd::Constant(columns, ridge);
  for (Eigen::Index j = 0; j < columns; ++j) {
    const std::string& name = names[static_cast<std::size_t>(j)];
    if (name == kConstant) ridges[j] = 0.0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      regressors(i, j) = RegressorOf(observations[static_cast<std::size_t>(i)], name);
    }
  }
  for (Eigen::Index i = 0; i < rows; ++i) {
    outcomes[i] = observations[static_cast<std::size_t>(i)].is_another ? 1.0 : 0.0;
  }
  // The loss is convex. Steps no longer than one do not pass its minimum by far.
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(columns);
  constexpr int kMost = 200;
  constexpr double kSettled = 1e-9;
  double moved = INFINITY;
  for (int iteration = 0; iteration < kMost && moved > kSettled; ++iteration) {
    const Quadratic loss = QuadraticAt(weights, regressors, outcomes, ridges);
    Eigen::VectorXd step = loss.curvature.ldlt().solve(loss.gradient);
    step *= std::min(1.0, 1.0 / step.norm());
    weights -= step;
    moved = step.norm();
  }
  if (!(moved <= kSettled)) throw std::invalid_argument("the odds have no weights without a ridge");
  LogisticModel model;
  for (Eigen::Index j = 0; j < columns; ++j) {
    model.weights[names[static_cast<std::size_t>(j)]] = weights[j];
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
