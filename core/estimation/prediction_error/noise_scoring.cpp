#include "telltale/core/estimation/prediction_error/noise_scoring.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/estimation/prediction_error/innovations.hpp"

namespace telltale {
namespace {

constexpr int kNoises = 8;
using NoiseVector = Eigen::Matrix<double, kNoises, 1>;

NoiseVector LogOf(const NoiseModel& noise) {
  NoiseVector log;
  log << noise.acceleration_sigma, noise.acceleration_time_constant_s, noise.fix_drift_sigma_m,
      noise.fix_sigma_m, noise.heading_sigma_rad, noise.stamp_sigma_s;
  return log.array().log();
}

NoiseModel NoiseOf(const NoiseVector& log) {
  const NoiseVector v = log.array().exp();
  return {v.head<3>(), v[3], v[4], v[5], v[6], v[7]};
}

NoiseVector NoisePriorMean() {
  return LogOf({{0.1, 0.1, 0.1}, 2.0, 0.1, 0.05, 0.02, 0.02});
}
constexpr double kNoisePriorSigma = 1.5;

NoiseVector LeastOf(NoiseFloor floor) {
  if (floor == NoiseFloor::kOfReadings)
    return LogOf({{1e-3, 1e-3, 1e-3}, 1.0, 0.1, 0.05, 0.0175, 0.02});
  return LogOf({{1e-3, 1e-3, 1e-3}, 1.0, 0.02, 0.005, 0.0044, 0.002});
}

NoiseVector Greatest() {
  return LogOf({{3.0, 3.0, 3.0}, 10.0, 3.0, 3.0, 0.2, 0.2});
}

/// Root mean square of the surge accelerations between rows half a second apart or more.
double TypicalAcceleration(const PreparedDataset& dataset) {
  constexpr double kApartS = 0.5;
  double squares = 0.0;
  double count = 0.0;
  for (const RowRange& segment : dataset.segments) {
    std::size_t from = segment.begin;
    for (std::size_t to = segment.begin; to < segment.end; ++to) {
      const double span_s = dataset.rows[to].time_s - dataset.rows[from].time_s;
      if (span_s < kApartS) continue;
      squares += std::pow((dataset.rows[to].nu.u - dataset.rows[from].nu.u) / span_s, 2);
      count += 1.0;
      from = to;
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

constexpr double kStep = 0.05;  // of a logarithm, of finite differences

/// A noise, and the same with each of its logarithms moved by a step.
std::vector<NoiseModel> WithSteps(const NoiseModel& noise) {
  std::vector<NoiseModel> moved(kNoises + 1, noise);
  for (Eigen::Index j = 0; j < kNoises; ++j) {
    NoiseVector log = LogOf(noise);
    log[j] += kStep;
    moved[static_cast<std::size_t>(j) + 1] = NoiseOf(log);
  }
  return moved;
}

/// The score of the logarithms of a noise and its information.
struct NoiseScore {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;

  /// Of the prior.
  explicit NoiseScore(const NoiseVector& log)
      : information(Eigen::MatrixXd::Identity(kNoises, kNoises) / std::pow(kNoisePriorSigma, 2)),
        gradient((NoisePriorMean() - log) / std::pow(kNoisePriorSigma, 2)) {}

  /// Innovations under the noise, and under it with each step.
  void Add(const std::vector<std::vector<Innovation>>& run) {
    for (std::size_t k = 0; k < run[0].size(); ++k) {
      const Innovation& i = run[0][k];
      NoiseVector by_log_variance;
      NoiseVector by_value;
      for (int j = 0; j < kNoises; ++j) {
        const Innovation& m = run[static_cast<std::size_t>(j) + 1][k];
        by_log_variance[j] = std::log(m.variance / i.variance) / kStep;
        by_value[j] = (m.value - i.value) / kStep;
      }
      const double square = i.value * i.value / i.variance;
      information += 0.5 * by_log_variance * by_log_variance.transpose() +
                     by_value * by_value.transpose() / i.variance;
      gradient += 0.5 * (square - 1.0) * by_log_variance - by_value * (i.value / i.variance);
    }
  }

  /// At most a factor e.
  NoiseVector Step() const {
    Eigen::VectorXd step = information.ldlt().solve(gradient);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > 1.0) step /= largest;
    return step;
  }
};

}  // namespace

NoiseModel FirstNoise(const PreparedDataset& dataset) {
  constexpr double kOfTypical = 3.0;
  constexpr double kWidest = 0.5;  // m/s^2, rad/s^2
  NoiseModel noise = NoiseOf(NoisePriorMean().cwiseMax(LeastOf(NoiseFloor::kOfReadings)));
  const double sigma = kOfTypical * TypicalAcceleration(dataset);
  noise.acceleration_sigma.setConstant(sigma > 0.0 ? std::min(sigma, kWidest) : kWidest);
  noise.acceleration_time_constant_s = 1.0;
  return noise;
}

NoiseScoring::NoiseScoring(const PreparedDataset& dataset, std::size_t threads)
    : dataset_(dataset), threads_(threads), excerpts_(ExcerptsOf(dataset)) {}

double NoiseScoring::Step(const SettingsUnder& settings_under, NoiseFloor floor,
                          std::vector<NoiseModel>& noise) const {
  std::vector<std::vector<NoiseModel>> moved;
  std::ranges::transform(noise, std::back_inserter(moved), WithSteps);
  const std::vector<Runs> runs = RunsUnder(moved, settings_under);
  double largest_move = 0.0;
  for (std::size_t recording = 0; recording < noise.size(); ++recording) {
    const NoiseVector log = LogOf(noise[recording]);
    NoiseScore score(log);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (dataset_.RecordingOf(excerpts_[i].segment) == recording) score.Add(runs[i]);
    }
    const NoiseVector next = (log + score.Step()).cwiseMax(LeastOf(floor)).cwiseMin(Greatest());
    noise[recording] = NoiseOf(next);
    largest_move = std::max(largest_move, (next - log).cwiseAbs().maxCoeff());
  }
  return largest_move;
}

std::vector<NoiseScoring::Excerpt> NoiseScoring::ExcerptsOf(const PreparedDataset& dataset) {
  constexpr std::size_t kExcerpts = 5;
  constexpr double kExcerptS = 60.0;
  std::vector<Excerpt> excerpts;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RawSignals& signals = dataset.signals[s];
    const std::vector<double>& times_s = signals.psi_rad.times_s;
    const double span_s = times_s.empty() ? 0.0 : times_s.back() - times_s.front();
    if (span_s <= kExcerpts * kExcerptS) {
      excerpts.push_back({s, signals});
      continue;
    }
    for (std::size_t i = 0; i < kExcerpts; ++i) {
      const double from_s =
          times_s.front() + static_cast<double>(i) * (span_s - kExcerptS) / (kExcerpts - 1);
      const double to_s = from_s + kExcerptS;
      excerpts.push_back(
          {s,
           {signals.north_m.Within(from_s, to_s), signals.east_m.Within(from_s, to_s),
            signals.psi_rad.Within(from_s, to_s)}});
    }
  }
  return excerpts;
}

/// By excerpt: its innovations under the noises of its recording, the first of which is that of the
/// filter.
std::vector<NoiseScoring::Runs> NoiseScoring::RunsUnder(
    const std::vector<std::vector<NoiseModel>>& of_recordings,
    const SettingsUnder& settings_under) const {
  std::vector<Runs> all(excerpts_.size());
  ForEachIndex(all.size(), threads_, [&](std::size_t i) {
    const auto& [segment, signals] = excerpts_[i];
    const std::vector<NoiseModel>& noises = of_recordings[dataset_.RecordingOf(segment)];
    all[i] = InnovationsUnder(noises, signals, dataset_.commands[segment],
                              settings_under(noises.front()));
  });
  return all;
}

}  // namespace telltale
