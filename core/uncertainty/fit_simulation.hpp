#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/vessel/disturbance.hpp"

namespace telltale {

/// A weak-form fit with the data and the options behind it. All outlive this.
struct FittedData {
  const PreparedDataset& dataset;
  const RegressionOptions& regression;
  const WeakIvOptions& options;
  const WeakFit& fit;
};

/// The dataset simulated anew, SimulateDataset(), by the model of the stacked unknowns `theta`:
/// same commands, fresh disturbance and sensor noise. `noise_scale`: standard deviation of the
/// sensor noise, in units of what the data show. Equations that were not fitted move as measured.
/// The readings behind the rows are left out.
/// Refuses when: the simulation diverges.
Result<PreparedDataset> SimulateFit(const FittedData& fitted, const Eigen::VectorXd& theta,
                                    const Disturbance& disturbance, double noise_scale,
                                    std::uint64_t seed);

}  // namespace telltale
