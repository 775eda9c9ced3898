#pragma once

#include <optional>
#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/options.hpp"
#include "telltale/core/identification/progress.hpp"
#include "telltale/core/validation/held_out_score.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// The structure that suits a recording, and why.
struct StructureChoice {
  Structure structure = Structure::kUnknown;
  std::string reason;                 ///< a sentence without its stop, "physical form, since ..."
  std::optional<HeldOutScore> score;  ///< of this structure, where it could be measured
  /// The physical model of all data, where it was identified beside its score.
  std::optional<Result<Identification>> physical;
};

/// Chooses between the physical form and the free coefficients of `options.regression` by what they
/// predict 5 s ahead of the last fifth of the recording. The error is the geometric mean over the
/// velocities in which constant velocity errs by more than sensors do, see CountsInFreeRuns().
/// The physical form has the fewer unknowns. Free coefficients replace it where at least ten free
/// runs show their error below 0.7 of its own, since fewer scatter by more than that, and below
/// half of constant velocity's: two models that hardly predict say nothing of each other.
/// Of a recording too short for ten runs, free coefficients are not tried.
/// The physical form is not tried where the other's error is below a tenth of constant velocity's.
/// Of a recording longer than `HeldOutOptions::most_fixes` the last part decides.
/// Where a second thread may be used, it identifies the physical form from all data meanwhile,
/// which most recordings end up with.
///
/// Assumes: `options.regression.structure` is one of free coefficients.
StructureChoice ChooseStructure(const Recording& recording, const Vehicle& vehicle,
                                const IdentifyOptions& options, const Progress& progress = {});

/// A model, and what it predicts of data set aside: nothing where the recording gives no score.
struct ScoredModel {
  Identification model;
  std::optional<HeldOutScore> score;
};

/// Identifies a model in the structure of `options`. Of the physical form, a second thread measures
/// the score meanwhile, where one may be used. Refuses as Identify does.
Result<ScoredModel> IdentifyInGivenStructure(const Recording& recording, const Vehicle& vehicle,
                                             const IdentifyOptions& options,
                                             const Progress& progress = {});

/// Identifies a model in the structure that ChooseStructure chooses, in free coefficients where the
/// physical form is refused; its provenance says why. Refuses as Identify does. Assumes: as
/// ChooseStructure.
Result<ScoredModel> IdentifyInChosenStructure(const Recording& recording, const Vehicle& vehicle,
                                              const IdentifyOptions& free_options,
                                              const Progress& progress = {});

}  // namespace telltale
