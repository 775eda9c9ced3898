#pragma once

#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/effects/augmented_model.hpp"

namespace telltale {

/// The force and moment that would have to be added to `boat` for it to accelerate as the recording
/// does, and what they vary over.
/// Model: X = m e_u, Y = (m + A22) e_v, N = (I + A66) e_r of the residual accelerations e from row
/// to row, each over its response to a constant acceleration, docs/concepts/diagnosis.md (122),
/// with the masses of the dataset's hull; A11 is neglected. Means are by bin of each variable,
/// their 95 % intervals from the scatter of sums over kDiagnosis.localisation.cluster_s. A variable
/// counts where the bins differ by more than chance, corrected for all components and variables
/// (Bonferroni); its share is the mean square between bins, less what chance puts there, over that
/// of the cluster means. Units: N, N, N m; those of ForceVariable. Assumes: sensors are right. A
/// fault of a sensor shows as a force as well. Requires: at least one reference, whose scatter says
/// what is nominal.
MissingForce MissingForceOf(const PreparedDataset& recording,
                            const std::vector<PreparedDataset>& references,
                            const AugmentedModel& boat);

}  // namespace telltale
