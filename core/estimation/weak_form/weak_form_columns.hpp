#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"

namespace telltale {

/// Every regressor of every equation: the columns to seek when the data move all of them.
std::array<std::vector<std::size_t>, 3> AllColumns(Parameterization parameterization);

/// `columns` with RecordingBiasTerms in place of the regressor "1". Each term stands in every
/// equation that has a support in its recording. Terms that depend on psi are taken only from
/// recordings where `heading_varies`. `columns` unchanged if the problem has no such terms.
std::array<std::vector<std::size_t>, 3> WithRecordingBiasTerms(
    const PreparedDataset& dataset, const WeakProblem& problem,
    const std::array<std::vector<std::size_t>, 3>& columns,
    const std::vector<bool>& heading_varies);

}  // namespace telltale
