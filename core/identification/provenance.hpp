#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "telltale/core/data/recording_identity.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/model_change.hpp"

namespace telltale {

/// The data that an identification uses.
struct WindowSummary {
  double start_s = 0.0;
  double end_s = 0.0;
  std::size_t samples = 0;   ///< prepared rows
  std::size_t segments = 0;  ///< runs of rows without a gap
  std::size_t slices = 0;    ///< segments cut further at each change of propeller region
  RejectCounts rejected;
};

/// How an identification was computed, enough to repeat it.
struct Provenance {
  std::string preset;        ///< of the data preparation
  std::string bounds_basis;  ///< the method behind standard errors and intervals, in words
  std::size_t bootstrap_replicates = 0;
  std::size_t bootstrap_failures = 0;  ///< replicates that could not be solved
  std::uint64_t seed = 0;
  std::string software_version;
  std::size_t parametric_replicates = 0;          ///< parametric bootstrap replicates identified
  std::size_t parametric_replicate_failures = 0;  ///< those that could not be identified
  std::string structure_choice;  ///< why this structure, a sentence; empty where it was named
  std::string estimator_choice;  ///< why this estimator, a sentence; empty where it was named
  /// Standard errors by cluster over naive ones, of output error; 0 where it is not computed. A
  /// ratio well above one shows a disturbance or a model error besides sensor noise.
  double misspecification = 0.0;
  std::size_t clusters = 0;  ///< independent clusters of time behind the covariance; 0: no clusters
  std::optional<ModelChange> change;  ///< against an earlier model, where there is one
  /// Those that made the model, by which they are known again; empty where nobody recorded them, as
  /// in a model of the daemon's window.
  std::vector<RecordingIdentity> recordings;
};

}  // namespace telltale
