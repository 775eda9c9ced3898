#include "telltale/core/uncertainty/fit_simulation.hpp"

#include <array>

#include "telltale/core/simulation/synthetic_dataset.hpp"

namespace telltale {

Result<PreparedDataset> SimulateFit(const FittedData& fitted, const Eigen::VectorXd& theta,
                                    const Disturbance& disturbance, double noise_scale,
                                    std::uint64_t seed) {
  const WeakFit& fit = fitted.fit;
  const std::array<bool, 3> as_measured = {!fit.equations[0], !fit.equations[1], !fit.equations[2]};
  return SimulateDataset(fitted.dataset, ModelOf(fit, theta, fitted.dataset.sampling_period_s),
                         {disturbance, noise_scale, seed, as_measured,
                          ConstantDisturbancesOf(fit, theta), Readings::kLeftOut});
}

}  // namespace telltale
