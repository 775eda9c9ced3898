#pragma once

#include <array>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"

namespace telltale {

/// Columns of each equation of the weak form, parted into what can be sought and what hinders it.
struct SeparableColumns {
  std::array<std::vector<std::size_t>, 3> kept;  ///< of those asked for; no two stand for the same
  /// Dependencies that were cut by leaving one of their columns out: no coefficient of a group can
  /// be told, while the others, and what the model predicts of like motion, stay as they are.
  std::array<std::vector<CollinearGroup>, 3> groups;
};

/// Weighed commands that only ever take a few levels make columns that are one another's
/// combinations to the last digit, where rows of (13) still differ by how filtering rounds the
/// steps: the weak form then has no solution. As long as the condition of an equation's unit-scaled
/// columns is above `worst_condition`, the largest column of the dependency is left out.
SeparableColumns Separate(const PreparedDataset& dataset, const RegressionOptions& regression,
                          const std::array<std::vector<std::size_t>, 3>& columns,
                          const WeakFormOptions& form, double worst_condition = 1000.0);

}  // namespace telltale
