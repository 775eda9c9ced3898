#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// One-step score of one velocity: the paper's R2 and MAE, and the R2 of predicting no change. An
/// R2 is NaN when the measured velocity never changes.
struct OneStepScore {
  double r2 = 0.0;
  double mae = 0.0;  ///< m/s or rad/s
  double constant_velocity_r2 = 0.0;
};

/// Free-run score of one velocity over one horizon, over all instants after the first of every run.
/// A model that diverges within a run has infinite errors. The noise floor is
/// PreparedDataset::nu_noise, the uncertainty of the measured velocities: errors against them are
/// no smaller. It is a lower bound: noise slower than white, the uncertain start of a run and the
/// smoothing of true transients add to it.
struct FreeRunScore {
  double rmse = 0.0;  ///< m/s or rad/s
  double mae = 0.0;
  double r2 = 0.0;
  double constant_velocity_rmse = 0.0;  ///< holding the initial velocity
  double noise_floor = 0.0;             ///< one sigma of the measured velocity
};

struct FreeRunScores {
  double horizon_s = 0.0;
  std::array<FreeRunScore, 3> velocity;  ///< surge, sway, yaw
  double position_rmse_m = 0.0;          ///< at the end of the horizon
  std::size_t windows = 0;
};

/// Whether a model diverges in these free runs: an error reaches `limits`, m/s and rad/s, or is
/// no number.
bool Diverges(const FreeRunScores& scores, const Nu& limits);

/// Sums over pairs of a true and a predicted velocity, of one component.
class ErrorSums {
 public:
  void Add(double truth, double predicted);

  double R2() const;
  double Mae() const { return absolute_error_ / count_; }
  double Rmse() const;

 private:
  double count_ = 0.0;
  double mean_ = 0.0;
  double squared_spread_ = 0.0;
  double squared_error_ = 0.0;
  double absolute_error_ = 0.0;
};

/// Sums over predicted velocities of a model, and of constant velocity beside it.
class VelocityErrorSums {
 public:
  /// `start`: the velocity from which the prediction was made.
  void Add(const Nu& start, const Nu& truth, const Nu& predicted);

  std::array<OneStepScore, 3> OfOneStep() const;
  /// `noise`: PreparedDataset::nu_noise.
  std::array<FreeRunScore, 3> OfFreeRuns(const Nu& noise) const;

 private:
  std::array<ErrorSums, 3> of_model_;
  std::array<ErrorSums, 3> of_constant_velocity_;
};

/// Sums over the free runs of one horizon.
class FreeRunSums {
 public:
  /// The run predicted from row `first` on; Predicted has a pose `eta` and a velocity `nu`.
  template <class Predicted>
  void Add(const PreparedDataset& dataset, const std::vector<Predicted>& run, std::size_t first) {
    const Nu& start = dataset.rows[first].nu;
    for (std::size_t k = 1; k < run.size(); ++k) {
      velocities_.Add(start, dataset.rows[first + k].nu, run[k].nu);
    }
    AddEnd(dataset.rows[first + run.size() - 1].eta, run.back().eta);
  }

  FreeRunScores Scores(const PreparedDataset& dataset, double horizon_s) const;

 private:
  void AddEnd(const Eta& truth, const Eta& predicted);

  VelocityErrorSums velocities_;
  double squared_distance_m2_ = 0.0;
  std::size_t windows_ = 0;
};

}  // namespace telltale
