#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Dense>

#include "support/stable_boat.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/diagnosis/residuals/free_runs.hpp"

namespace telltale::testing {

/// A boat that nothing drives or brakes lies with its bow to the north and is recorded for a
/// minute, by sensors without noise. An acceleration moves its free runs by the second integral
/// over time, the start of each window being estimated: errors in closed form.
struct RestingBoat {
  static constexpr double kHorizonS = 5.0;

  explicit RestingBoat(double duration_s = 60.0)
      : dataset(Recorded(duration_s)), runs(dataset, model, kHorizonS) {}

  /// What is left, bin by bin, of the mean over a channel's samples of value(t) once the straight
  /// line that an estimated start can give is taken from it, by least squares over the samples'
  /// number. t is since the window began. Shapes: one row a bin.
  Eigen::VectorXd LeftByTheStart(std::size_t window, Eigen::Index channel,
                                 const std::function<double(double)>& value) const {
    const std::vector<double>& times_s = channel == 2 ? dataset.signals.front().psi_rad.times_s
                                                      : dataset.signals.front().north_m.times_s;
    const Eigen::Index bins = runs.Rows() / 3;
    Eigen::VectorXd count = Eigen::VectorXd::Zero(bins);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(bins);
    Eigen::MatrixXd line = Eigen::MatrixXd::Zero(bins, 2);
    for (const double time_s : times_s) {
      const double t = time_s - runs.Of(window).time_s;
      const auto bin =
          static_cast<Eigen::Index>(std::ceil(t * static_cast<double>(bins) / kHorizonS - 1e-6)) -
          1;
      if (bin < 0 || bin >= bins) continue;
      count[bin] += 1.0;
      mean[bin] += value(t);
      line.row(bin) += Eigen::RowVector2d(1.0, t);
    }
    mean.array() /= count.array();
    line.array().colwise() /= count.array();
    const Eigen::MatrixXd weighted = line.transpose() * count.asDiagonal();
    return mean - line * (weighted * line).ldlt().solve(weighted * mean);
  }

  /// The rows of a channel among errors of a window: 0 along, 1 across, 2 heading.
  static Eigen::VectorXd ChannelOf(const Eigen::VectorXd& errors, Eigen::Index channel) {
    return errors(Eigen::seq(channel, Eigen::last, 3));
  }

  VesselModel model = VesselModel::OfZeros(
      Structure::kStaticQuadratic, Parameterization::kPropeller, Discretisation::kContinuous, 0.2);
  PreparedDataset dataset;
  FreeRuns runs;

 private:
  static PreparedDataset Recorded(double duration_s) {
    constexpr double kStepS = 0.02;
    std::vector<TimedState> track;
    for (int i = 0; kStepS * i <= duration_s; ++i) track.push_back({kStepS * i, {}, {}});
    PrepareOptions options;
    options.sampling_period_s = 0.2;
    return Prepare(Measure(track, Vehicle{}, NoNoise()), Vehicle{}, options).value();
  }
};

}  // namespace telltale::testing
