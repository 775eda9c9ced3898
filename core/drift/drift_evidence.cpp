#include "telltale/core/drift/drift_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Cholesky>

#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/diagnosis/residuals/sensitivity.hpp"
#include "telltale/core/drift/drift_constants.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kSideslipTerms = 5;
constexpr Eigen::Index kForces = kDrift.changes.size() + kDrift.nuisances.size();
constexpr double kStartStates = 6.0;  // of a window, which its errors are free of

std::span<const PreparedRow> RowsOf(const PreparedDataset& dataset,
                                    const FreeRuns::Circumstances& window) {
  return std::span(dataset.rows).subspan(window.first_row, window.rows);
}

struct Sideslip {
  double v = 0.0;         ///< m/s, mean over the window
  Eigen::VectorXd terms;  ///< u, cos psi, sin psi, r, u r: means
};

Sideslip SideslipOf(std::span<const PreparedRow> rows) {
  Sideslip mean{0.0, Eigen::VectorXd::Zero(kSideslipTerms)};
  for (const PreparedRow& row : rows) {
    const double psi = row.eta.psi_rad;
    Eigen::VectorXd terms(kSideslipTerms);
    terms << row.nu.u, std::cos(psi), std::sin(psi), row.nu.r, row.nu.u * row.nu.r;
    mean.terms += terms;
    mean.v += row.nu.v;
  }
  mean.terms /= static_cast<double>(rows.size());
  mean.v /= static_cast<double>(rows.size());
  return mean;
}

/// Greatest less smallest of what `of` takes of the rows.
template <class Of>
double RangeOf(std::span<const PreparedRow> rows, Of of) {
  const auto [least, most] = std::ranges::minmax(rows, {}, of);
  return of(most) - of(least);
}

bool CommandsVary(std::span<const PreparedRow> rows) {
  const double port = RangeOf(rows, [](const PreparedRow& row) { return row.delta.port; });
  const double starboard =
      RangeOf(rows, [](const PreparedRow& row) { return row.delta.starboard; });
  return std::max(port, starboard) >= kDrift.least_command_range;
}

bool Turns(std::span<const PreparedRow> rows) {
  return RangeOf(rows, [](const PreparedRow& row) { return row.eta.psi_rad; }) >=
         kDrift.least_heading_range_rad;
}

/// By how much errors fall for one unit of each change and nuisance that the model leaves out.
std::vector<Eigen::MatrixXd> SlopesOf(const FreeRuns& runs, const VesselModel& model,
                                      const Eigen::MatrixXd& errors) {
  std::vector<Eigen::MatrixXd> slopes;
  const auto add = [&](const auto& watched) {
    const ModelledEffect moved = At({FindEffect(watched.effect), watched.parameter}, watched.step);
    slopes.push_back((errors - runs.Errors({model, {moved}})) / watched.step);
  };
  std::ranges::for_each(kDrift.changes, add);
  std::ranges::for_each(kDrift.nuisances, add);
  return slopes;
}

/// Whether a run stays near what was measured; false where its error is not a number.
bool StaysNear(const Eigen::VectorXd& error) {
  return (error.array().abs() <= kDrift.largest_error).all();
}

/// Weight of a window, less than one where its errors are far beyond the ordinary.
double WeightOf(double squared_error, Eigen::Index rows) {
  const double limit = kDrift.largest_sigmas * kDrift.largest_sigmas * static_cast<double>(rows);
  return squared_error > limit ? std::sqrt(limit / squared_error) : 1.0;
}

/// Of the secant of a change, or of a nuisance.
double StepOf(Eigen::Index i) {
  const auto at = static_cast<std::size_t>(i);
  return at < kDrift.changes.size() ? kDrift.changes[at].step
                                    : kDrift.nuisances[at - kDrift.changes.size()].step;
}

ChangeEquations FreeRunEquations(const std::vector<Eigen::MatrixXd>& slopes,
                                 const Eigen::MatrixXd& errors, Eigen::Index window,
                                 const DriftReference& reference) {
  Eigen::MatrixXd of_window(errors.rows(), kForces);
  for (Eigen::Index i = 0; i < kForces; ++i) {
    of_window.col(i) = slopes[static_cast<std::size_t>(i)].col(window);
  }
  const Eigen::VectorXd error = errors.col(window);
  // Where the model, or what it would be after a change, diverges, nothing is linear.
  bool diverges = !StaysNear(error);
  for (Eigen::Index i = 0; i < kForces; ++i) {
    diverges = diverges || !StaysNear(error - of_window.col(i) * StepOf(i));
  }
  if (diverges) return ChangeEquations::OfZeros(kForces);
  const double squared = error.dot(reference.weights * error);
  const double weight = WeightOf(squared, errors.rows());
  const Eigen::MatrixXd weighted = weight * of_window.transpose() * reference.weights;
  return {weighted * of_window, weighted * error, weight * squared,
          static_cast<double>(errors.rows()) - kStartStates};
}

ChangeEquations SideslipEquations(const Sideslip& now, const DriftReference& reference) {
  const double beyond = now.v - reference.sideslip.dot(now.terms);
  Eigen::VectorXd terms = now.terms;
  terms[0] = -terms[0];  // a compass that reads too high shows sideslip to port
  const double variance = reference.sideslip_variance;
  return {terms * terms.transpose() / variance, terms * (beyond / variance),
          beyond * beyond / variance, 1.0};
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

DriftEvidence DriftEvidence::None() {
  return {ChangeEquations::OfZeros(kForces), ChangeEquations::OfZeros(kSideslipTerms)};
}

void DriftEvidence::Add(const DriftEvidence& more) {
  free_runs.Add(more.free_runs);
  sideslip.Add(more.sideslip);
}

std::optional<DriftReference> DriftReferenceOf(const PreparedDataset& nominal,
                                               const VesselModel& model) {
  const FreeRuns runs(nominal, model, kDrift.window_s);
  if (runs.Windows() < kDrift.reference_windows) return std::nullopt;
  const Eigen::MatrixXd errors = runs.Errors({model, {}});
  const auto windows = static_cast<Eigen::Index>(runs.Windows());
  for (Eigen::Index w = 0; w < windows; ++w) {
    if (!StaysNear(errors.col(w))) return std::nullopt;
  }
  Eigen::MatrixXd terms(windows, kSideslipTerms);
  Eigen::VectorXd v(windows);
  for (Eigen::Index w = 0; w < windows; ++w) {
    const Sideslip sideslip = SideslipOf(RowsOf(nominal, runs.Of(static_cast<std::size_t>(w))));
    terms.row(w) = sideslip.terms.transpose();
    v[w] = sideslip.v;
  }
  // A ridge for a boat that keeps to one course, where the terms are collinear.
  const Eigen::MatrixXd information = terms.transpose() * terms;
  const Eigen::MatrixXd ridge =
      1e-3 * information.trace() * Eigen::MatrixXd::Identity(kSideslipTerms, kSideslipTerms);
  DriftReference reference;
  reference.weights = ShrunkInverse(errors);
  reference.sideslip = (information + ridge / static_cast<double>(kSideslipTerms))
                           .ldlt()
                           .solve(terms.transpose() * v);
  reference.sideslip_variance =
      std::max(1e-8, (v - terms * reference.sideslip).squaredNorm() / static_cast<double>(windows));
  return reference;
}

DriftEvidence SumOf(std::span<const DriftEvidence> windows) {
  DriftEvidence sum = DriftEvidence::None();
  for (const DriftEvidence& window : windows) sum.Add(window);
  return sum;
}

std::vector<DriftEvidence> DriftEvidenceOf(const PreparedDataset& dataset, const VesselModel& model,
                                           const DriftReference& reference) {
  const FreeRuns runs(dataset, model, kDrift.window_s);
  std::vector<DriftEvidence> evidence(runs.Windows(), DriftEvidence::None());
  if (evidence.empty()) return evidence;
  const Eigen::MatrixXd errors = runs.Errors({model, {}});
  const std::vector<Eigen::MatrixXd> slopes = SlopesOf(runs, model, errors);
  for (std::size_t w = 0; w < runs.Windows(); ++w) {
    const auto rows = RowsOf(dataset, runs.Of(w));
    if (CommandsVary(rows)) {
      evidence[w].free_runs =
          FreeRunEquations(slopes, errors, static_cast<Eigen::Index>(w), reference);
    }
    if (Turns(rows)) evidence[w].sideslip = SideslipEquations(SideslipOf(rows), reference);
  }
  return evidence;
}

}  // namespace telltale
