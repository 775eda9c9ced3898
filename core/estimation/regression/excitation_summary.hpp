#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/vessel/regressors.hpp"

namespace telltale {

/// A coefficient's part in a combination of coefficients, each scaled by the norm of its column, so
/// that weights compare whatever the units; the largest weight of a combination is one.
struct CombinationTerm {
  std::size_t regressor = 0;  ///< position in Regressors()
  double weight = 0.0;

  bool operator==(const CombinationTerm&) const = default;
};

/// How well the data separate one equation's coefficients, and from how many observations.
struct ExcitationSummary {
  Equation equation = Equation::kUnknown;
  double condition = 1.0;  ///< largest over smallest singular value of the unit-scaled columns
  /// One for each of Regressors(), docs/concepts/model.md (62): how many times the variance of a
  /// coefficient exceeds its value without collinearity. Infinite where not
  /// excited.
  std::vector<double> variance_inflation;
  std::vector<CombinationTerm> least_separable;  ///< the least identifiable combination, (63)
  std::size_t rows = 0;  ///< or supports of the weak form; 0: not counted, as of output error
  double effective_rows = 0.0;  ///< effective independent observations, (64)
};

/// The numbers that excitation alone decides; rows are left at zero.
ExcitationSummary Summarise(const Excitation& excitation, std::size_t regressors);

}  // namespace telltale
