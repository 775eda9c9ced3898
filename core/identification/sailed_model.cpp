#include "identification/sailed_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>

#include "identification/tamed_model.hpp"
#include "number.hpp"
#include "simulation/free_run.hpp"

namespace telltale {
namespace {

constexpr double kRunsOfS[] = {5.0, 15.0, 30.0};

/// The nearest coefficients within their bounds.
Eigen::VectorXd WithinBounds(const Identification& identification, Eigen::VectorXd theta) {
  Eigen::Index next = 0;
  for (const Coefficient& c : identification.coefficients) {
    double& value = theta[next++];
    value = std::clamp(value, c.interval.lower, c.interval.upper);
  }
  return theta;
}

/// Largest distance of a coefficient from its estimate, in standard errors.
double Furthest(const Identification& identification, const Eigen::VectorXd& theta) {
  double furthest = 0.0;
  Eigen::Index next = 0;
  for (const Coefficient& c : identification.coefficients) {
    const double off = std::abs(theta[next++] - c.estimate);
    if (off > 0.0) furthest = std::max(furthest, off / c.standard_error);
  }
  return furthest;
}

/// The length of the longest free runs that neither run away themselves nor do shorter ones: long
/// runs are few, and start from few states. Zero where some of the shortest run away.
double SailsForS(const PreparedDataset& dataset, const VesselModel& model) {
  double longest_s = 0.0;
  for (const double horizon_s : kRunsOfS) {
    const Runaways count = CountRunaways(dataset, model, horizon_s);
    if (count.runaways > 0) break;
    if (count.runs > 0) longest_s = horizon_s;
  }
  return longest_s;
}

/// Coefficients to sail with.
struct Drawing {
  Eigen::VectorXd theta;
  double furthest = 0.0;  ///< from the estimates, in standard errors
  double sails_s = 0.0;
};

/// Those within the bounds that sail for longest, and of them the nearest to the estimates.
std::optional<Drawing> DrawnIn(const PreparedDataset& dataset, Identification identification) {
  std::optional<Drawing> best;
  for (const double trust : kTrusts) {
    const Eigen::VectorXd theta =
        WithinBounds(identification, TamedEstimates(identification, trust));
    identification.sailed.assign(theta.begin(), theta.end());
    const double sails_s = SailsForS(dataset, *ModelOf(identification));
    if (sails_s > (best ? best->sails_s : 0.0)) {
      best = Drawing{theta, Furthest(identification, theta), sails_s};
    }
    if (sails_s == *std::rbegin(kRunsOfS)) break;
  }
  return best;
}

/// In how many of the shortest runs in which it does so at all the model runs away.
std::optional<std::string> RunsAway(const PreparedDataset& dataset, const VesselModel& model) {
  for (const double horizon_s : kRunsOfS) {
    const Runaways count = CountRunaways(dataset, model, horizon_s);
    if (count.runaways == 0) continue;
    return "in " + std::to_string(count.runaways) + " of " + std::to_string(count.runs) +
           " runs of " + Number(horizon_s, 0) + " s over its own recording";
  }
  return std::nullopt;
}

/// How the model is sailed in spite of its estimates, if it can be.
std::optional<std::string> DrawIn(const PreparedDataset& dataset, Identification& identification) {
  if (identification.estimator == Estimator::kOneStep) return std::nullopt;
  const auto drawing = DrawnIn(dataset, identification);
  if (!drawing) return std::nullopt;
  identification.sailed.assign(drawing->theta.begin(), drawing->theta.end());
  return "it is sailed with coefficients drawn towards zero along what the data leave open, by " +
         Number(drawing->furthest, 1) + " standard errors at most, and so runs for " +
         Number(drawing->sails_s, 0) + " s";
}

}  // namespace

void SeekToSail(const PreparedDataset& dataset, Identification& identification) {
  const auto model = ModelOf(identification);
  if (!model) return;
  const auto runaways = RunsAway(dataset, *model);
  if (!runaways) return;
  Refusal warning{"free run", *runaways + " the model runs away as estimated: ",
                  "record more varied manoeuvres for longer"};
  if (const auto how = DrawIn(dataset, identification)) {
    warning.reason += *how;
  } else {
    warning.reason += "its bounds say what the data leave open, but it is not to be sailed";
    if (identification.estimator != Estimator::kOneStep) {
      warning.advice +=
          ", or see by `validate` on another recording whether the one-step "
          "estimator's model predicts better, without bounds that hold";
    }
  }
  identification.refusals.push_back(std::move(warning));
}

}  // namespace telltale
