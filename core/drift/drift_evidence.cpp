#include "telltale/core/drift/drift_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>

#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/diagnosis/residuals/sensitivity.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kSideslipTerms = 5;
constexpr Eigen::Index kWeather = kDrift.weather.size();

std::span<const PreparedRow> RowsOf(const PreparedDataset& dataset,
                                    const FreeRuns::Circumstances& window) {
  return std::span(dataset.rows).subspan(window.first_row, window.rows);
}

struct Sideslip {
  double v = 0.0;         ///< m/s, mean over the window
  Eigen::VectorXd terms;  ///< u, cos psi, sin psi, r, u r: means
};

Sideslip SideslipOf(const PreparedDataset& dataset, const FreeRuns::Circumstances& window) {
  Sideslip mean{0.0, Eigen::VectorXd::Zero(kSideslipTerms)};
  for (const PreparedRow& row : RowsOf(dataset, window)) {
    const double psi = row.eta.psi_rad;
    Eigen::VectorXd terms(kSideslipTerms);
    terms << row.nu.u, std::cos(psi), std::sin(psi), row.nu.r, row.nu.u * row.nu.r;
    mean.terms += terms;
    mean.v += row.nu.v;
  }
  mean.terms /= static_cast<double>(window.rows);
  mean.v /= static_cast<double>(window.rows);
  return mean;
}

/// Greatest less smallest of what `of` takes of the rows.
template <class Of>
double RangeOf(std::span<const PreparedRow> rows, Of of) {
  const auto [least, most] = std::ranges::minmax(rows, {}, of);
  return of(most) - of(least);
}

bool IsVaried(std::span<const PreparedRow> rows) {
  const double port = RangeOf(rows, [](const PreparedRow& row) { return row.delta.port; });
  const double starboard =
      RangeOf(rows, [](const PreparedRow& row) { return row.delta.starboard; });
  return std::max(port, starboard) >= kDrift.least_command_range;
}

bool Turns(std::span<const PreparedRow> rows) {
  return RangeOf(rows, [](const PreparedRow& row) { return row.eta.psi_rad; }) >=
         kDrift.least_heading_range_rad;
}

/// By how much errors fall for one unit of a parameter that the model leaves out.
Eigen::MatrixXd Slope(const FreeRuns& runs, const VesselModel& model, const Eigen::MatrixXd& errors,
                      std::string_view effect, std::size_t parameter, double step) {
  const ModelledEffect modelled = At({FindEffect(effect), parameter}, step);
  return (errors - runs.Errors({model, {modelled}})) / step;
}

/// Weight of a window, less than one where its errors are far beyond the ordinary.
double WeightOf(double squared_error, Eigen::Index rows) {
  const double limit = kDrift.largest_sigmas * kDrift.largest_sigmas * static_cast<double>(rows);
  return squared_error > limit ? std::sqrt(limit / squared_error) : 1.0;
}

void WriteCompass(const Sideslip& now, const DriftReference& reference, DriftEvidence& evidence) {
  const double beyond = now.v - reference.sideslip.dot(now.terms);
  Eigen::VectorXd terms = now.terms;
  terms[0] = -terms[0];  // a compass that reads too high shows sideslip to port
  evidence.compass.information = terms * terms.transpose() / reference.sideslip_variance;
  evidence.compass.projection = terms * beyond / reference.sideslip_variance;
}

Eigen::MatrixXd ShrunkInverse(const Eigen::MatrixXd& errors) {
  const Eigen::MatrixXd covariance =
      errors * errors.transpose() / static_cast<double>(errors.cols());
  const double share = kDrift.covariance_shrinkage;
  const Eigen::MatrixXd shrunk =
      (1.0 - share) * covariance + share * Eigen::MatrixXd(covariance.diagonal().asDiagonal());
  return shrunk.ldlt().solve(Eigen::MatrixXd::Identity(errors.rows(), errors.rows()));
}

}  // namespace

std::optional<DriftReference> DriftReferenceOf(const PreparedDataset& nominal,
                                               const VesselModel& model) {
  const FreeRuns runs(nominal, model, kDrift.window_s);
  if (runs.Windows() < kDrift.reference_windows) return std::nullopt;
  const auto windows = static_cast<Eigen::Index>(runs.Windows());
  Eigen::MatrixXd terms(windows, kSideslipTerms);
  Eigen::VectorXd v(windows);
  for (Eigen::Index w = 0; w < windows; ++w) {
    const Sideslip sideslip = SideslipOf(nominal, runs.Of(static_cast<std::size_t>(w)));
    terms.row(w) = sideslip.terms.transpose();
    v[w] = sideslip.v;
  }
  // A ridge for a boat that keeps to one course, where the terms are collinear.
  const Eigen::MatrixXd information = terms.transpose() * terms;
  const Eigen::MatrixXd ridge =
      1e-3 * information.trace() * Eigen::MatrixXd::Identity(kSideslipTerms, kSideslipTerms);
  DriftReference reference;
  reference.weights = ShrunkInverse(runs.Errors({model, {}}));
  reference.sideslip = (information + ridge / static_cast<double>(kSideslipTerms))
                           .ldlt()
                           .solve(terms.transpose() * v);
  reference.sideslip_variance =
      std::max(1e-8, (v - terms * reference.sideslip).squaredNorm() / static_cast<double>(windows));
  return reference;
}

std::vector<DriftEvidence> DriftEvidenceOf(const PreparedDataset& dataset, const VesselModel& model,
                                           const DriftReference& reference) {
  const FreeRuns runs(dataset, model, kDrift.window_s);
  std::vector<DriftEvidence> all(runs.Windows());
  if (all.empty()) return all;
  const Eigen::MatrixXd errors = runs.Errors({model, {}});
  std::vector<Eigen::MatrixXd> by_weather;
  for (const WatchedWeather& weather : kDrift.weather) {
    by_weather.push_back(
        Slope(runs, model, errors, weather.effect, weather.parameter, weather.step));
  }
  for (std::size_t j = 0; j < kDrift.changes.size(); ++j) {
    const WatchedChange& change = kDrift.changes[j];
    const Eigen::MatrixXd by_change =
        Slope(runs, model, errors, change.effect, change.parameter, change.step);
    for (std::size_t w = 0; w < all.size(); ++w) {
      const auto column = static_cast<Eigen::Index>(w);
      Eigen::MatrixXd slopes(errors.rows(), 1 + kWeather);
      slopes.col(0) = by_change.col(column);
      for (Eigen::Index i = 0; i < kWeather; ++i) {
        slopes.col(1 + i) = by_weather[static_cast<std::size_t>(i)].col(column);
      }
      const Eigen::VectorXd error = errors.col(column);
      const double weight = WeightOf(error.dot(reference.weights * error), errors.rows());
      const Eigen::MatrixXd weighted = weight * slopes.transpose() * reference.weights;
      all[w].changes[j] = {weighted * slopes, weighted * error};
    }
  }
  for (std::size_t w = 0; w < all.size(); ++w) {
    const auto window = runs.Of(w);
    all[w].end_s = window.time_s + kDrift.window_s;
    all[w].is_varied = IsVaried(RowsOf(dataset, window));
    all[w].turns = Turns(RowsOf(dataset, window));
    WriteCompass(SideslipOf(dataset, window), reference, all[w]);
  }
  return all;
}

}  // namespace telltale
