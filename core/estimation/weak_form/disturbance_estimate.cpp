#include "telltale/core/estimation/weak_form/disturbance_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "telltale/core/estimation/regression/residual_autocovariance.hpp"
#include "telltale/core/estimation/weak_form/constant_disturbances.hpp"
#include "telltale/core/estimation/weak_form/instruments.hpp"

namespace telltale {
namespace {

/// The autocorrelation of the weights by lag in rows; lag zero stands in the middle.
Eigen::VectorXd ProductsByLag(const Eigen::VectorXd& weights) {
  const Eigen::Index middle = weights.size() - 1;
  Eigen::VectorXd products = Eigen::VectorXd::Zero(2 * middle + 1);
  for (Eigen::Index a = 0; a < weights.size(); ++a) {
    for (Eigen::Index b = 0; b < weights.size(); ++b) {
      products[middle + a - b] += weights[a] * weights[b];
    }
  }
  return products;
}

/// The autocovariance, by lag in supports, of a unit Gauss-Markov process filtered by weights with
/// this autocorrelation. It ends where it is negligible.
Eigen::VectorXd FilteredAutocovariance(const Eigen::VectorXd& products, double h,
                                       std::size_t stride, double time_constant_s) {
  constexpr double kLongestInTimeConstants = 5.0;
  const Eigen::Index middle = products.size() / 2;
  const double support_spacing_s = h * static_cast<double>(stride);
  const double longest_s =
      kLongestInTimeConstants * time_constant_s + h * static_cast<double>(products.size());
  Eigen::VectorXd filtered =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(longest_s / support_spacing_s) + 1);
  for (Eigen::Index l = 0; l < filtered.size(); ++l) {
    for (Eigen::Index d = -middle; d <= middle; ++d) {
      const double apart_s =
          std::abs(static_cast<double>(d) * h + static_cast<double>(l) * support_spacing_s);
      filtered[l] += products[middle + d] * std::exp(-apart_s / time_constant_s);
    }
  }
  return filtered;
}

/// Values from `least` to `most` in `steps` steps of equal ratio.
std::vector<double> GeometricGrid(double least, double most, int steps) {
  std::vector<double> all;
  for (int i = 0; i <= steps; ++i) {
    all.push_back(least * std::pow(most / least, static_cast<double>(i) / steps));
  }
  return all;
}

/// The time constants among which the disturbance's is chosen, s.
std::vector<double> TimeConstants() {
  return GeometricGrid(0.2, 40.0, 30);
}

/// The drifts among which that of the fixes is chosen, m within a second.
std::vector<double> DriftSizes() {
  return GeometricGrid(1e-3, 1.0, 72);
}

/// For each time constant: the best variance of one axis, and the squared misfit of the
/// autocovariance as a share of the squared residual variance.
struct AxisFits {
  Eigen::VectorXd variance;
  Eigen::VectorXd misfit;
};

/// Autocovariances of one equation's residuals by lag in supports.
struct AxisAutocovariances {
  Eigen::VectorXd beyond_noise;
  Eigen::VectorXd by_drift;            ///< per squared metre of drift within a second
  std::vector<Eigen::VectorXd> units;  ///< of a disturbance of variance one, by time constant
  double residual_variance = 0.0;
};

AxisFits FitAxis(const AxisAutocovariances& axis, double drift_m) {
  const Eigen::VectorXd shown = axis.beyond_noise - drift_m * drift_m * axis.by_drift;
  AxisFits fits{Eigen::VectorXd(std::ssize(axis.units)), Eigen::VectorXd(std::ssize(axis.units))};
  for (std::size_t i = 0; i < axis.units.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd& unit = axis.units[i];
    fits.variance[at] = std::max(0.0, unit.dot(shown) / unit.squaredNorm());
    fits.misfit[at] = (shown - fits.variance[at] * unit).squaredNorm() /
                      (axis.residual_variance * axis.residual_variance);
  }
  return fits;
}

using Axes = std::array<std::optional<AxisAutocovariances>, 3>;  ///< of the answered equations

struct DisturbanceFit {
  Disturbance disturbance;
  double misfit = 0.0;
};

/// The best-fitting disturbance for a given drift of the fixes.
DisturbanceFit FitDisturbance(const Axes& axes, const std::vector<double>& time_constants,
                              double drift_m) {
  // An axis whose residuals are mostly noise hardly determines its own time constant. The misfit of
  // the other axes then decides, since a disturbance usually acts on all three.
  constexpr double kWeightOfOthers = 0.25;
  std::array<std::optional<AxisFits>, 3> fits;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(std::ssize(time_constants));
  for (std::size_t j = 0; j < axes.size(); ++j) {
    if (!axes[j]) continue;
    fits[j] = FitAxis(*axes[j], drift_m);
    all += fits[j]->misfit;
  }
  DisturbanceFit fit;
  fit.disturbance.gnss_drift_m = drift_m;
  for (std::size_t j = 0; j < fits.size(); ++j) {
    if (!fits[j]) continue;
    Eigen::Index best = 0;
    const Eigen::VectorXd misfit = fits[j]->misfit + kWeightOfOthers * (all - fits[j]->misfit);
    fit.misfit += misfit.minCoeff(&best);
    const auto row = static_cast<Eigen::Index>(j);
    fit.disturbance.sigma[row] = std::sqrt(fits[j]->variance[best]);
    fit.disturbance.time_constant_s[row] = time_constants[static_cast<std::size_t>(best)];
  }
  return fit;
}

/// The fit without drift, unless drift removes at least half of its misfit. Of fixes without drift
/// it removes a twentieth by chance; of drifting fixes, nearly all.
Disturbance BestDisturbance(const Axes& axes, const std::vector<double>& time_constants) {
  constexpr double kUnexplainedWithDrift = 0.5;
  const DisturbanceFit without_drift = FitDisturbance(axes, time_constants, 0.0);
  DisturbanceFit best = without_drift;
  for (const double drift_m : DriftSizes()) {
    const DisturbanceFit with_drift = FitDisturbance(axes, time_constants, drift_m);
    if (with_drift.misfit < best.misfit) best = with_drift;
  }
  return best.misfit < kUnexplainedWithDrift * without_drift.misfit ? best.disturbance
                                                                    : without_drift.disturbance;
}

}  // namespace

std::array<Eigen::VectorXd, 3> ResidualsOf(const WeakFit& fit, const Eigen::VectorXd& theta,
                                           const PreparedDataset& dataset,
                                           const WeakProblem& problem) {
  const FilteredThrust thrust =
      FilterThrust(dataset, problem, fit.time_constant_s ? std::optional(theta[0]) : std::nullopt);
  std::array<std::vector<std::size_t>, 3> columns;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (fit.equations[j]) columns[j] = fit.equations[j]->columns;
  }
  const auto predicted = Instruments(dataset, problem)
                             .Predict(ModelOf(fit, theta, dataset.sampling_period_s),
                                      ConstantDisturbancesOf(fit, theta), columns, thrust);
  std::array<Eigen::VectorXd, 3> residuals;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j].empty()) continue;
    const TestFunctionSupports& supports = problem.supports[j];
    const auto [begin, size] = fit.BlockOf(j);
    const Eigen::MatrixXd G =
        ProjectRegressors(dataset, problem, thrust, kEquations[j])(Eigen::all, columns[j]) +
        predicted[j].filtering_loss;
    residuals[j] = ProjectAcceleration(problem, supports, dataset, kEquations[j]) -
                   G * theta.segment(begin, size);
  }
  return residuals;
}

SensorAutocovariances::SensorAutocovariances() {
  noise.fill(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kDisturbanceLags)));
  drift = noise;
}

Disturbance EstimateDisturbance(const PreparedDataset& dataset, const WeakFit& fit,
                                const SensorAutocovariances& sensor_autocovariances) {
  const WeakProblem& problem = fit.problem;
  const Eigen::VectorXd products =
      ProductsByLag(FilteredTestFunction(FilterOnIntervals(dataset), problem.phi));
  const std::vector<double> time_constants = TimeConstants();
  std::vector<Eigen::VectorXd> filtered;
  for (const double tau : time_constants) {
    filtered.push_back(
        FilteredAutocovariance(products, dataset.sampling_period_s, problem.phi.stride, tau));
  }
  Axes axes;
  for (std::size_t j = 0; j < axes.size(); ++j) {
    if (!fit.equations[j]) continue;
    const WeakEstimate& estimate = *fit.equations[j];
    const auto runs = RunsOf(problem.supports[j].first_rows, problem.phi.stride);
    const auto [begin, size] = fit.BlockOf(j);
    const Eigen::MatrixXd response = estimate.G * fit.bread.block(begin, begin, size, size);
    const Eigen::VectorXd shown = Autocovariance(runs, estimate.residual, kDisturbanceLags);
    AxisAutocovariances& axis = axes[j].emplace();
    axis.beyond_noise = shown - sensor_autocovariances.noise[j];
    axis.by_drift = sensor_autocovariances.drift[j];
    axis.residual_variance = shown[0];
    for (const Eigen::VectorXd& of_tau : filtered) {
      axis.units.push_back(
          AutocovarianceAfterFit(runs, of_tau, response, estimate.Z, kDisturbanceLags));
    }
  }
  return BestDisturbance(axes, time_constants);
}

}  // namespace telltale
