#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/drift/change_estimate.hpp"
#include "telltale/core/drift/drift_constants.hpp"
#include "telltale/core/vessel/vessel_model.hpp"

namespace telltale {

/// What a boat's errors are like while nothing has changed.
struct DriftReference {
  /// Inverse covariance of the errors of a free run, FreeRuns. Its scale does not matter.
  Eigen::MatrixXd weights;
  /// Sideslip by SideslipTerms, by least squares, and the variance that it leaves, (m/s)^2.
  Eigen::VectorXd sideslip;
  double sideslip_variance = 0.0;
};

/// The reference of a recording on which the model fits. Requires: a model with all three
/// equations. Nothing where it has fewer windows than kDrift.reference_windows.
std::optional<DriftReference> DriftReferenceOf(const PreparedDataset& nominal,
                                               const VesselModel& model);

/// What one window says of the changes that are watched for.
struct DriftEvidence {
  double end_s = 0.0;
  /// Whether the commands change. At one operating point the error that a model has there looks
  /// like a change of thrust or drag.
  bool is_varied = false;
  /// Whether the heading changes. On one course current and wind look like a turned compass.
  bool turns = false;
  /// By kDrift.changes: free-run errors by that change, then by weather, whitened.
  std::array<NormalEquations, kDrift.changes.size()> changes;
  /// Sideslip by misalignment of the compass, then by what else makes it, in units of its sigma.
  NormalEquations compass;
};

/// The evidence of each window of a dataset, in order of time.
/// Model: errors of free runs from an estimated start are to first order linear in the size of an
/// effect, docs/concepts/diagnosis.md (101). A turned compass hides in the estimated start, but
/// turns the measured velocity: v = v_nominal - bias u, (102).
std::vector<DriftEvidence> DriftEvidenceOf(const PreparedDataset& dataset, const VesselModel& model,
                                           const DriftReference& reference);

}  // namespace telltale
