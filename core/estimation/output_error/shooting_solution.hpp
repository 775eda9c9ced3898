#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/shooting_residual.hpp"

namespace telltale {

/// A ridge prior on theta. The scale of a coefficient is the value that takes the boat through the
/// standard deviation of its velocity in one second. Data that determine a coefficient outweigh the
/// prior by orders of magnitude. Along directions that they do not determine it keeps theta near
/// the centre.
struct RidgePrior {
  Eigen::VectorXd centre;
  Eigen::VectorXd weight;  ///< one over that scale
};

RidgePrior MakeRidgePrior(const PreparedDataset& dataset, const SharedUnknowns& unknowns,
                          const Eigen::VectorXd& centre);

/// Theta and the initial states of the shooting segments, which together minimise the sum of
/// squared residuals and of the ridge prior, docs/concepts/model.md (50). Assumes: plan, unknowns
/// and prior outlive it.
class ShootingSolution {
 public:
  /// Each shooting segment starts from its guess.
  ShootingSolution(const ShootingPlan& plan, const SharedUnknowns& unknowns,
                   const RidgePrior& ridge_prior, double huber_threshold,
                   const Eigen::VectorXd& theta);

  const Eigen::VectorXd& Theta() const { return theta_; }
  const std::vector<ShootingState>& Starts() const { return starts_; }

  void MoveTo(const Eigen::VectorXd& theta, const std::vector<ShootingState>& starts);

  /// Whether the simulation of some shooting segment diverges.
  bool Diverges() const;

  std::optional<ShootingResidual> ComputeResidual(std::size_t shooting_segment,
                                                  const NoiseScale& noise_scale,
                                                  bool with_derivatives) const;

  /// The scale of the present residuals by their medians, never less than the sensors' noise.
  NoiseScale Measure() const;

  std::size_t CountBeyondThreshold(const NoiseScale& noise_scale) const;

  /// The objective; infinite where a shooting segment diverges.
  double Sum(const NoiseScale& noise_scale) const;

  /// Moves to the least sum under this noise scale; whether it converged. One of the unknowns may
  /// be held constant.
  bool Descend(const NoiseScale& noise_scale, double tolerance, int iterations,
               std::optional<Eigen::Index> held = std::nullopt);

 private:
  /// Visits the residuals of fixes, as north-east pairs, and of headings.
  template <class Visit>
  void ForEachResidual(Visit visit) const;

  const ShootingPlan& plan_;
  const SharedUnknowns& unknowns_;
  const RidgePrior& ridge_prior_;
  double huber_threshold_;
  Eigen::VectorXd theta_;
  std::vector<ShootingState> starts_;
};

}  // namespace telltale
