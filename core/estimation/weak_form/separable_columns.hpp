#pragma once

#include <array>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/near_dependency.hpp"
#include "telltale/core/estimation/weak_form/weak_form.hpp"

namespace telltale {

/// The columns of each equation of the weak form that can be estimated together.
struct SeparableColumns {
  std::array<std::vector<std::size_t>, 3> kept;  ///< of those asked for, free of dependencies
  /// Dependencies, each resolved by leaving one of its columns out. No coefficient of a group is
  /// identifiable. The other coefficients and predictions of similar motion do not depend on the
  /// choice.
  std::array<std::vector<CollinearGroup>, 3> groups;
};

/// Removes collinear columns. Commands of only a few levels make projected columns exactly linearly
/// dependent, and the weak form then has no solution. The rows of (13) differ even then, because
/// filtering rounds the steps. As long as the condition index of an equation's columns of unit norm
/// is at least `worst_condition`, the column with the largest component of the dependency is left
/// out. An equation with no more supports than columns keeps them all.
SeparableColumns Separate(const PreparedDataset& dataset, const RegressionOptions& regression,
                          const std::array<std::vector<std::size_t>, 3>& columns,
                          const WeakFormOptions& form, double worst_condition = 1000.0);

}  // namespace telltale
