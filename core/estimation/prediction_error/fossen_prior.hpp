#pragma once

#include "telltale/core/vessel/fossen_model.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Weakly informative normal priors of the physical parameters, truncated to their physical range.
/// docs/concepts/physical-model.md lists them with their sources. They scale with the length of the
/// hull, that of the vehicle file or twice the distance between the propellers.
struct FossenPrior {
  FossenVector mean;
  FossenVector standard_deviation;
  FossenVector least;                 ///< lower end of the physical range
  FossenVector greatest;              ///< upper end
  double reverse_over_forward = 0.8;  ///< thrust at full command, of a T200
  double reverse_over_forward_sigma = 0.25;
  double current_sigma_m_s = 0.3;
  double misalignment_sigma_rad = 0.087;  ///< 5 degrees

  /// Whether a standard error is so near that of the prior that the prior decides the parameter,
  /// not the data.
  bool Decides(Eigen::Index parameter, double standard_error) const {
    constexpr double kOfPrior = 0.8;
    return standard_error > kOfPrior * standard_deviation[parameter];
  }
};

FossenPrior PriorOf(const Vehicle& vehicle);

}  // namespace telltale
