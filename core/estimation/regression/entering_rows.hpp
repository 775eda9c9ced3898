#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// Which rows of a dataset enter every one of some equations.
class EnteringRows {
 public:
  EnteringRows(const PreparedDataset& dataset, std::span<const Equation> equations,
               const RegressionOptions& regression);

  /// Whether rows [first, first + count) all enter.
  bool All(std::size_t first, std::size_t count) const;

  /// The longest runs of entering rows within `rows`, in order.
  std::vector<RowRange> RunsIn(const RowRange& rows) const;

 private:
  std::vector<std::size_t> entering_until_;  ///< by row: one past the entering run that holds it
};

}  // namespace telltale
