#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/drift/change_equations.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// What a boat's errors are like while nothing has changed.
struct DriftReference {
  /// Inverse covariance of the errors of a free run, FreeRuns.
  Eigen::MatrixXd weights;
  /// Sideslip over u, cos psi, sin psi, r and u r by least squares, and the variance that it
  /// leaves, (m/s)^2.
  Eigen::VectorXd sideslip;
  double sideslip_variance = 0.0;
};

/// The reference of a recording on which the model fits. Requires: a model with all three
/// equations. Nothing where it has fewer windows than kDrift.reference_windows, and where the model
/// diverges in one of them.
std::optional<DriftReference> DriftReferenceOf(const PreparedDataset& nominal,
                                               const VesselModel& model);

/// What a window, or several, say of the changes that are watched for.
struct DriftEvidence {
  ChangeEquations free_runs;  ///< errors by kDrift.changes, then by kDrift.nuisances
  ChangeEquations sideslip;   ///< by misalignment of the compass, then by what else makes it

  static DriftEvidence None();
  void Add(const DriftEvidence& more);
};

DriftEvidence SumOf(std::span<const DriftEvidence> windows);

/// The evidence of each window of a dataset, in order of time.
/// Model: errors of free runs from an estimated start are to first order linear in the size of an
/// effect, docs/concepts/diagnosis.md (124). A turned compass turns the measured velocity besides:
/// v = v_nominal - bias u, (125).
/// A window at constant commands tells nothing of forces: the error that a model has at one
/// operating point, and an autopilot that answers gusts, look like a change there. One on a
/// constant heading tells nothing of sideslip: current and wind look like a turned compass.
std::vector<DriftEvidence> DriftEvidenceOf(const PreparedDataset& dataset, const VesselModel& model,
                                           const DriftReference& reference);

}  // namespace telltale
