#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/shooting.hpp"

namespace telltale {

inline constexpr double kLongestLagS = 20.0;  ///< time constant that is sought by shooting

/// Where theta begins and how far a coefficient may reasonably move from there: by what would take
/// the boat through the spread of its velocities in a second. Data that tell anything overrule it
/// by orders of magnitude; along what they do not tell it keeps theta from wandering off.
struct Leash {
  Eigen::VectorXd centre;
  Eigen::VectorXd weight;  ///< one over that reach
};

Leash LeashOn(const PreparedDataset& dataset, const SharedUnknowns& unknowns,
              const Eigen::VectorXd& centre);

/// Theta and the states in which the shots start, moving together towards the least sum of squared
/// misses and of what pulls at the leash. docs/model.md (50).
/// Assumes: plan, unknowns and leash outlive it.
class ShotSolution {
 public:
  /// Each shot starts where it was guessed to begin.
  ShotSolution(const ShotPlan& plan, const SharedUnknowns& unknowns, const Leash& leash,
               double knee, const Eigen::VectorXd& theta);

  const Eigen::VectorXd& Theta() const { return theta_; }
  const std::vector<ShotState>& Starts() const { return starts_; }

  void MoveTo(const Eigen::VectorXd& theta, const std::vector<ShotState>& starts);

  /// Whether some shot cannot be sailed to its end.
  bool RunsAway() const;

  std::optional<Miss> Sight(std::size_t shot, const Yardstick& yardstick,
                            bool with_derivatives) const;

  /// The sizes that residuals have now, by their medians, never less than the sensors' noise.
  Yardstick Measure() const;

  std::size_t CountPast(const Yardstick& yardstick) const;

  /// What is made least; infinite where a shot runs away.
  double Sum(const Yardstick& yardstick) const;

  /// Moves to the least sum by this yardstick; whether it got there. One of the unknowns may be
  /// held where it is.
  bool Descend(const Yardstick& yardstick, double tolerance, int iterations,
               std::optional<Eigen::Index> held = std::nullopt);

 private:
  /// Visits north-east pairs and headings one by one.
  template <class Visit>
  void ForEachResidual(Visit visit) const;

  const ShotPlan& plan_;
  const SharedUnknowns& unknowns_;
  const Leash& leash_;
  double knee_;
  Eigen::VectorXd theta_;
  std::vector<ShotState> starts_;
};

}  // namespace telltale
