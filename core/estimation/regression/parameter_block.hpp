#pragma once

#include <Eigen/Core>

namespace telltale {

/// Unknowns that stand together among the stacked ones: the time constant, or the coefficients of
/// one equation.
struct Block {
  Eigen::Index begin = 0;
  Eigen::Index size = 0;
};

}  // namespace telltale
