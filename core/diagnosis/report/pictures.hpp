#pragma once

#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/report/conclusion.hpp"
#include "telltale/core/diagnosis/report/horizon_gap.hpp"

namespace telltale {

/// Errors, motion and tracks of every window at the main horizon, before and after. `boat`: the
/// nominal boat. After is with the likely hypothesis, cross-validated; the tracks after are those
/// of the first fold's fit. Where no hypothesis is likely, after is as before.
std::vector<WindowPicture> PicturesOf(const PreparedDataset& recording, const HorizonErrors& main,
                                      const AugmentedModel& boat, const Conclusion& conclusion);

}  // namespace telltale
