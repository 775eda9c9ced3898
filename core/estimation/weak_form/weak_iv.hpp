#pragma once

#include <array>
#include <optional>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/constant_disturbances.hpp"
#include "telltale/core/estimation/weak_form/ridge_posterior.hpp"
#include "telltale/core/estimation/weak_form/smoothing_width.hpp"
#include "telltale/core/estimation/weak_form/weak_fit.hpp"
#include "telltale/core/estimation/weak_form/weak_form_columns.hpp"
#include "telltale/core/estimation/weak_form/weak_iv_covariance.hpp"

namespace telltale {

struct WeakIvOptions {
  WeakFormOptions form;
  double ridge = 0.02;  ///< of the model that simulates the instruments, relative to unit columns
  int iterations = 4;   ///< simulations of the instruments; twice as many with a time constant
  bool delays = true;   ///< whether delays between the channels are unknowns too
};

/// Weak-form instrumental variables, docs/concepts/model.md (31):
///   theta = (Z'V^-1 G)^-1 Z'V^-1 b
/// V is the covariance of the residuals as estimated from them (ResidualWhitening). Z is projected
/// like G, but from velocities that the model itself simulates (Instruments). These share the
/// commands with the boat and no noise with its sensors. The first model comes from regularised
/// least squares; each further iteration simulates with the newest theta. To first order the
/// estimate is corrected for what noise adds to G and for what filtering before multiplying removes
/// from it. Delays of the commands and of the fixes are unknowns to first order, (36), so that the
/// covariance holds for clocks that agree as well as the data can tell; longer delays are to be
/// taken out of the data first, PrepareWithClocksAligned().
/// Nothing when an equation has no more supports than columns, or when the instruments are not
/// finite or do not determine every unknown.
/// Requires: data prepared with the robust preset. `columns`: those sought, by equation, empty to
/// leave the equation out: places in Regressors() or, beyond those, in the RecordingBiasTerms that
/// regression.recording_bias asks for, which replace the regressor "1".
std::optional<WeakFit> EstimateWeakIv(const PreparedDataset& dataset,
                                      const RegressionOptions& regression,
                                      const std::array<std::vector<std::size_t>, 3>& columns,
                                      const WeakIvOptions& options);

}  // namespace telltale
