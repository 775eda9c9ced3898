#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/output_error/multiple_shooting.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {

/// Where theta begins and how far a coefficient may reasonably move from there: by what would take
/// the boat through the spread of its velocities in a second. Data that tell anything overrule it
/// by orders of magnitude; along what they do not tell it keeps theta from wandering off.
struct RidgePrior {
  Eigen::VectorXd centre;
  Eigen::VectorXd weight;  ///< one over that reach
};

RidgePrior MakeRidgePrior(const PreparedDataset& dataset, const SharedUnknowns& unknowns,
                          const Eigen::VectorXd& centre);

/// Theta and the states in which the shots start, moving together towards the least sum of squared
/// misses and of what pulls at the leash. docs/concepts/model.md (50).
/// Assumes: plan, unknowns and leash outlive it.
class ShootingSolution {
 public:
  /// Each shot starts where it was guessed to begin.
  ShootingSolution(const ShootingPlan& plan, const SharedUnknowns& unknowns,
                   const RidgePrior& ridge_prior, double huber_threshold,
                   const Eigen::VectorXd& theta);

  const Eigen::VectorXd& Theta() const { return theta_; }
  const std::vector<ShootingState>& Starts() const { return starts_; }

  void MoveTo(const Eigen::VectorXd& theta, const std::vector<ShootingState>& starts);

  /// Whether some shot cannot be sailed to its end.
  bool Diverges() const;

  std::optional<ShootingResidual> ComputeResidual(std::size_t shooting_segment,
                                                  const NoiseScale& noise_scale,
                                                  bool with_derivatives) const;

  /// The sizes that residuals have now, by their medians, never less than the sensors' noise.
  NoiseScale Measure() const;

  std::size_t CountBeyondThreshold(const NoiseScale& noise_scale) const;

  /// What is made least; infinite where a shot runs away.
  double Sum(const NoiseScale& noise_scale) const;

  /// Moves to the least sum by this yardstick; whether it got there. One of the unknowns may be
  /// held where it is.
  bool Descend(const NoiseScale& noise_scale, double tolerance, int iterations,
               std::optional<Eigen::Index> held = std::nullopt);

 private:
  /// Visits north-east pairs and headings one by one.
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
