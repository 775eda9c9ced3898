#pragma once

#include <cstdint>
#include <optional>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"

namespace telltale {

/// How many times the mean square that sensors alone leave in the weak form its residuals have, in
/// the equation where that is most; docs/concepts/model.md (55). About one where nothing but
/// sensors is at work. What sensors leave is what the fit leaves in a synthetic dataset that is
/// free of disturbance. Cheap, and blind to what is small against the noise of the sensors. Nothing
/// when the fit diverges.
std::optional<double> ResidualVarianceRatio(const PreparedDataset& dataset,
                                            const RegressionOptions& regression, const WeakFit& fit,
                                            const WeakFormOptions& form, std::uint64_t seed);

}  // namespace telltale
