#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "telltale/core/vessel/model_structure.hpp"

namespace telltale {

/// Propeller regressors as one vector: the four of surge, then the four of turning.
using ThrustTerms = Eigen::Matrix<double, 8, 1>;

inline ThrustTerms TermsOf(const ThrustRegressors& thrust) {
  ThrustTerms terms;
  std::ranges::copy(thrust.surge, terms.data());
  std::ranges::copy(thrust.turning, terms.data() + thrust.surge.size());
  return terms;
}

inline ThrustRegressors RegressorsOf(const ThrustTerms& terms) {
  ThrustRegressors thrust;
  std::copy_n(terms.data(), 4, thrust.surge.begin());
  std::copy_n(terms.data() + 4, 4, thrust.turning.begin());
  return thrust;
}

}  // namespace telltale
