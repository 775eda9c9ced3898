#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/identification/equation_estimates.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale {

/// Prepares a recording for the weak form: parts of a minute, whose synthetic datasets stay near
/// the data, and the narrowest filter that the noise of the positions allows.
/// Refuses when: Prepare does.
Result<PreparedDataset> PrepareForWeakIv(const Recording& recording, const Vehicle& vehicle,
                                         const PrepareOptions& options,
                                         Readings readings = Readings::kKept);

/// A weak-form fit before separation of columns, correction and bounds.
struct PreliminaryWeakFit {
  EquationEstimates equation_estimates;  ///< excitations and refusals
  std::array<std::vector<std::size_t>, 3> columns;
  std::optional<WeakFit> fit;  ///< of all excited columns
};

PreliminaryWeakFit FitPreliminaryWeakForm(const PreparedDataset& dataset,
                                          const RegressionOptions& regression,
                                          const IdentifyOptions& options);

/// Weak-form instrumental variables on the equations and columns that one-step regressions of the
/// same rows excite, corrected and calibrated by parametric bootstrap. `preliminary`: a fit of the
/// same data, if there is one already.
/// Refuses when: no equation can be answered, or simulated instruments say nothing of the data.
Result<BoundedEstimates> BoundWeakIv(const PreparedDataset& dataset,
                                     const RegressionOptions& regression,
                                     const IdentifyOptions& options, const Progress& progress,
                                     std::optional<PreliminaryWeakFit> preliminary = std::nullopt);

}  // namespace telltale
