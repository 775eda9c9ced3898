#include "telltale/core/validation/scores.hpp"

#include <cmath>
#include <limits>

namespace telltale {
namespace {

using Velocity = std::array<double, 3>;

Velocity ToArray(const Nu& nu) {
  return {nu.u, nu.v, nu.r};
}

// The error of a diverged free run is infinite, not NaN.
double ErrorOf(double truth, double predicted) {
  const double error = truth - predicted;
  return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

}  // namespace

bool Diverges(const FreeRunScores& scores, const Nu& limits) {
  const Velocity limit = ToArray(limits);
  for (std::size_t i = 0; i < limit.size(); ++i) {
    if (!(scores.velocity[i].rmse < limit[i])) return true;  // NaN and infinity too
  }
  return false;
}

void ErrorSums::Add(double truth, double predicted) {
  const double error = ErrorOf(truth, predicted);
  squared_error_ += error * error;
  absolute_error_ += std::abs(error);
  // Welford's update: the spread of a slow drift about a large mean survives rounding.
  count_ += 1.0;
  const double from_old_mean = truth - mean_;
  mean_ += from_old_mean / count_;
  squared_spread_ += from_old_mean * (truth - mean_);
}

double ErrorSums::R2() const {
  if (squared_spread_ <= 0.0) return std::numeric_limits<double>::quiet_NaN();
  return 1.0 - squared_error_ / squared_spread_;
}

double ErrorSums::Rmse() const {
  return std::sqrt(squared_error_ / count_);
}

void VelocityErrorSums::Add(const Nu& start, const Nu& truth, const Nu& predicted) {
  const Velocity nu = ToArray(truth);
  const Velocity nu_hat = ToArray(predicted);
  const Velocity nu_start = ToArray(start);
  for (std::size_t j = 0; j < nu.size(); ++j) {
    of_model_[j].Add(nu[j], nu_hat[j]);
    of_constant_velocity_[j].Add(nu[j], nu_start[j]);
  }
}

std::array<OneStepScore, 3> VelocityErrorSums::OfOneStep() const {
  std::array<OneStepScore, 3> scores;
  for (std::size_t j = 0; j < scores.size(); ++j) {
    scores[j] = {of_model_[j].R2(), of_model_[j].Mae(), of_constant_velocity_[j].R2()};
  }
  return scores;
}

std::array<FreeRunScore, 3> VelocityErrorSums::OfFreeRuns(const Nu& noise) const {
  const Velocity noise_floor = ToArray(noise);
  std::array<FreeRunScore, 3> scores;
  for (std::size_t j = 0; j < scores.size(); ++j) {
    scores[j] = {of_model_[j].Rmse(), of_model_[j].Mae(), of_model_[j].R2(),
                 of_constant_velocity_[j].Rmse(), noise_floor[j]};
  }
  return scores;
}

void FreeRunSums::AddEnd(const Eta& truth, const Eta& predicted) {
  const double north = ErrorOf(truth.x_m, predicted.x_m);
  const double east = ErrorOf(truth.y_m, predicted.y_m);
  squared_distance_m2_ += north * north + east * east;
  ++windows_;
}

FreeRunScores FreeRunSums::Scores(const PreparedDataset& dataset, double horizon_s) const {
  FreeRunScores scores;
  scores.horizon_s = horizon_s;
  scores.windows = windows_;
  if (windows_ == 0) return scores;
  scores.velocity = velocities_.OfFreeRuns(dataset.nu_noise);
  scores.position_rmse_m = std::sqrt(squared_distance_m2_ / static_cast<double>(windows_));
  return scores;
}

}  // namespace telltale
