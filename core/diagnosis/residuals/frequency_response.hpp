#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/free_runs.hpp"
#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// Mean over windows of the outer product of the errors that an acceleration of one frequency and
/// random phase leaves, per squared amplitude, for each axis: surge, sway, yaw.
using ResponseMoments = std::array<Eigen::MatrixXd, 3>;

/// Model: the mean over the phases of cos and sin, from small accelerations that stay linear.
/// `errors` are those of the boat itself.
ResponseMoments ResponseMomentsAt(double frequency_rad_s, const FreeRuns& runs,
                                  const AugmentedModel& boat, const Eigen::MatrixXd& errors);

/// The response moments of a recording over the frequency range of each stochastic effect, at
/// frequencies in even ratios.
class FrequencyResponse {
 public:
  struct Band {
    double frequency_rad_s = 0.0;
    ResponseMoments patterns;
  };

  /// `errors` as above.
  FrequencyResponse(std::span<const Effect* const> library, const FreeRuns& runs,
                    const AugmentedModel& boat, const Eigen::MatrixXd& errors, std::size_t threads);

  /// Lowest frequency first. Requires: a stochastic effect of the library.
  const std::vector<Band>& Of(const Effect& effect) const { return bands_.at(&effect); }

 private:
  std::map<const Effect*, std::vector<Band>> bands_;
};

}  // namespace telltale
