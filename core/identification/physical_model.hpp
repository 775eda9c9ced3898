#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/estimation/prediction_error/noise_model.hpp"
#include "telltale/core/identification/coefficient.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

/// The physical form of a boat with bounds; docs/concepts/physical-model.md.
/// Shapes: parameters and covariance in the order of FossenParameter. The equation of a parameter
/// is unknown, its regressor is empty. Standard errors and intervals are of each parameter by
/// itself, widened by what is known of its own; the covariance is for what several of them say
/// together, and widened by one factor.
struct PhysicalModel {
  std::vector<Coefficient> parameters;
  Eigen::MatrixXd covariance;
  double propeller_separation_m = 0.0;
  NoiseModel noise;  ///< the geometric mean over the recordings

  FossenVector Estimates() const {
    FossenVector estimates;
    for (std::size_t i = 0; i < kFossenParameters; ++i) {
      estimates[static_cast<Eigen::Index>(i)] = parameters[i].estimate;
    }
    return estimates;
  }
};

}  // namespace telltale
