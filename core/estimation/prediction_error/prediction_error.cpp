#include "telltale/core/estimation/prediction_error/prediction_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/estimation/prediction_error/innovations.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

constexpr Eigen::Index kParameters = static_cast<Eigen::Index>(kFossenParameters);
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

// A weak log-normal prior of the noise keeps a noise that the data do not show finite.
NoiseVector NoisePriorMean() {
  return LogOf({{0.1, 0.1, 0.1}, 2.0, 0.1, 0.05, 0.02, 0.02});
}
constexpr double kNoisePriorSigma = 1.5;

// The readings of a boat are smoother than they are true: an autopilot filters its fixes and
// headings. A noise below these would let the filter follow the readings instead of the model.
NoiseVector LeastNoise() {
  return LogOf({{1e-3, 1e-3, 1e-3}, 1.0, 0.1, 0.05, 0.0175, 0.02});
}
// A boat of the instruments that follows the filter is free of what disturbs the boat only as far
// as the noise of the filter is right.
NoiseVector LeastNoiseWhereFollowing() {
  return LogOf({{1e-3, 1e-3, 1e-3}, 1.0, 0.02, 0.005, 0.0044, 0.002});
}
NoiseVector GreatestNoise() {
  return LogOf({{3.0, 3.0, 3.0}, 10.0, 3.0, 3.0, 0.2, 0.2});
}

// Root mean square of the surge accelerations between rows half a second apart or more.
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

// Process noise wide enough that the filter follows the readings whatever the parameters are. Far
// above the accelerations of a slow boat it would leave nothing for the parameters to explain.
NoiseModel FirstNoise(const PreparedDataset& dataset) {
  constexpr double kOfTypical = 3.0;
  constexpr double kWidest = 0.5;  // m/s^2, rad/s^2
  NoiseModel noise = NoiseOf(NoisePriorMean().cwiseMax(LeastNoise()));
  const double sigma = kOfTypical * TypicalAcceleration(dataset);
  noise.acceleration_sigma.setConstant(sigma > 0.0 ? std::min(sigma, kWidest) : kWidest);
  noise.acceleration_time_constant_s = 1.0;
  return noise;
}

// A boat that keeps no course by itself soon leaves the one that the commands alone drive, which
// then tells nothing of it. One that follows it slowly stays near, and is less free of what
// disturbs the boat; in s.
constexpr double kDrivenByCommandsAlone = std::numeric_limits<double>::infinity();
constexpr std::array kFollowingSlowly = {5.0, 10.0, 20.0};

using Runs = std::vector<std::vector<Innovation>>;  // by noise
using SlopedRuns = std::vector<SlopedInnovations>;  // by segment

// Readings of one segment, from which the noise of its recording is found.
struct Excerpt {
  std::size_t segment = 0;
  RawSignals signals;
};

// Five minutes of a recording show its noise well enough: of a longer segment, five even excerpts
// of a minute.
std::vector<Excerpt> ExcerptsForNoise(const PreparedDataset& dataset) {
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

// Of all segments together.
double SpanS(const PreparedDataset& dataset) {
  double span_s = 0.0;
  for (const RawSignals& signals : dataset.signals) {
    const std::vector<double>& times_s = signals.psi_rad.times_s;
    if (!times_s.empty()) span_s += times_s.back() - times_s.front();
  }
  return span_s;
}

class Problem {
 public:
  Problem(const PreparedDataset& dataset, double separation_m, const FossenPrior& prior,
          const PredictionErrorOptions& options)
      : dataset_(dataset),
        separation_m_(separation_m),
        prior_(prior),
        options_(options),
        for_noise_(ExcerptsForNoise(dataset)) {}

  FilterSettings SettingsOf(const Eigen::VectorXd& z, const NoiseModel& noise,
                            double nominal_fix_delay_s) const {
    FilterSettings settings;
    settings.parameters = z.head<kParameters>();
    settings.nominal_fix_delay_s = nominal_fix_delay_s;
    settings.current_sigma_m_s = prior_.current_sigma_m_s;
    settings.misalignment_sigma_rad = prior_.misalignment_sigma_rad;
    settings.noise = noise;
    settings.propeller_separation_m = separation_m_;
    settings.antenna = dataset_.sensors.antenna;
    return settings;
  }

  // `instrument_time_constant_s`: nothing where the slopes are the instruments.
  SlopedRuns RunWithSlopes(const Eigen::VectorXd& z, const std::vector<NoiseModel>& noise,
                           std::optional<double> instrument_time_constant_s) const {
    SlopedRuns all(dataset_.segments.size());
    ForEachIndex(all.size(), options_.threads, [&](std::size_t s) {
      FilterSettings settings = SettingsOf(z, noise[dataset_.RecordingOf(s)], z[At(kFixDelay)]);
      settings.instrument_time_constant_s =
          instrument_time_constant_s.value_or(kDrivenByCommandsAlone);
      all[s] = SlopedInnovationsOf(dataset_.signals[s], dataset_.commands[s], settings,
                                   instrument_time_constant_s.has_value());
    });
    return all;
  }

  // By excerpt and noise: its innovations under those of its recording, the first of which is that
  // of the filter.
  std::vector<Runs> RunForNoise(const Eigen::VectorXd& z,
                                const std::vector<std::vector<NoiseModel>>& of_recordings) const {
    std::vector<Runs> all(for_noise_.size());
    ForEachIndex(all.size(), options_.threads, [&](std::size_t i) {
      const auto& [segment, signals] = for_noise_[i];
      const std::vector<NoiseModel>& noises = of_recordings[dataset_.RecordingOf(segment)];
      all[i] = InnovationsUnder(noises, signals, dataset_.commands[segment],
                                SettingsOf(z, noises.front(), z[At(kFixDelay)]));
    });
    return all;
  }

  std::size_t RecordingOfExcerpt(std::size_t i) const {
    return dataset_.RecordingOf(for_noise_[i].segment);
  }

  // The sum of weighted squares at fixed gains, which the normal equations are those of.
  double SquaresWith(const SlopedRuns& runs, const Eigen::VectorXd& z,
                     const std::vector<NoiseModel>& noise, double nominal_fix_delay_s) const {
    std::vector<double> sums(dataset_.segments.size(), 0.0);
    ForEachIndex(sums.size(), options_.threads, [&](std::size_t s) {
      const FilterSettings settings =
          SettingsOf(z, noise[dataset_.RecordingOf(s)], nominal_fix_delay_s);
      for (const Innovation& i :
           InnovationsWith(runs[s].gains, dataset_.signals[s], dataset_.commands[s], settings)) {
        sums[s] += i.value * i.value / i.variance;
      }
    });
    double sum = 0.0;
    for (const double of_segment : sums) sum += of_segment;
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }

  // The mean of the prior, and a reverse loss that the fastest tenth of the rows would show: the
  // slope of one far above their speeds vanishes.
  Eigen::VectorXd FirstParameters() const {
    std::vector<double> speeds_m_s;
    for (const PreparedRow& row : dataset_.rows) speeds_m_s.push_back(row.nu.u);
    Eigen::VectorXd first = prior_.mean;
    if (speeds_m_s.empty()) return first;
    const auto fast = speeds_m_s.begin() + static_cast<std::ptrdiff_t>(9 * speeds_m_s.size() / 10);
    std::ranges::nth_element(speeds_m_s, fast);
    if (*fast > 0.0) {
      first[At(kReverseLoss)] =
          std::clamp(1.0 / *fast, first[At(kReverseLoss)], prior_.greatest[At(kReverseLoss)]);
    }
    return first;
  }

  // The precision matrix and mean of the prior; that of reverse thrust depends on forward thrust.
  Eigen::MatrixXd PriorPrecision(const Eigen::VectorXd& z) const {
    Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(kParameters, kParameters);
    for (Eigen::Index i = 0; i < kParameters; ++i) {
      precision(i, i) = 1.0 / std::pow(prior_.standard_deviation[i], 2);
    }
    const Eigen::VectorXd row = ReverseRow();
    const double forward = std::max(z[At(kForwardLinear)] + z[At(kForwardQuadratic)], 0.05);
    precision += row * row.transpose() / std::pow(prior_.reverse_over_forward_sigma * forward, 2);
    return precision;
  }

  Eigen::VectorXd ReverseRow() const {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(kParameters);
    row[At(kReverseLinear)] = row[At(kReverseQuadratic)] = 1.0;
    row[At(kForwardLinear)] = row[At(kForwardQuadratic)] = -prior_.reverse_over_forward;
    return row;
  }

  // The mean of the joint normal that the separate priors make.
  Eigen::VectorXd PriorShift(const Eigen::MatrixXd& precision) const {
    Eigen::VectorXd weighted = Eigen::VectorXd::Zero(kParameters);
    for (Eigen::Index i = 0; i < kParameters; ++i) {
      weighted[i] = prior_.mean[i] / std::pow(prior_.standard_deviation[i], 2);
    }
    return precision.ldlt().solve(weighted);
  }

  bool Feasible(const Eigen::VectorXd& z) const {
    const double m = z[At(kM22)] * z[At(kM33)] - z[At(kM23)] * z[At(kM23)];
    return m > 0.05 * z[At(kM22)] * z[At(kM33)];
  }

  const PreparedDataset& dataset_;
  double separation_m_;
  const FossenPrior& prior_;
  const PredictionErrorOptions& options_;
  std::vector<Excerpt> for_noise_;
};

struct Normal {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;            // half of that of the objective
  std::vector<ScoreBlock> blocks;      // of the data, by time
  std::vector<ScoreBlock> recordings;  // the same by recordings
};

// The slopes, or the instruments, of so many innovations from `first` on, each over the standard
// deviation of its innovation.
Eigen::MatrixXd Standardised(const SlopedInnovations& run, FossenVector InnovationSlope::*member,
                             std::size_t first, std::size_t count) {
  Eigen::MatrixXd columns(kParameters, count);
  for (std::size_t k = 0; k < count; ++k) {
    columns.col(static_cast<Eigen::Index>(k)) =
        run.slopes[first + k].*member / std::sqrt(run.innovations[first + k].variance);
  }
  return columns;
}

Eigen::MatrixXd Standardised(const SlopedInnovations& run, FossenVector InnovationSlope::*member) {
  return Standardised(run, member, 0, run.slopes.size());
}

Eigen::VectorXd StandardisedValues(const SlopedInnovations& run, std::size_t first,
                                   std::size_t count) {
  Eigen::VectorXd values(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Innovation& i = run.innovations[first + k];
    values[static_cast<Eigen::Index>(k)] = i.value / std::sqrt(i.variance);
  }
  return values;
}

// The normal equations of one segment by blocks of time.
std::vector<ScoreBlock> BlocksOf(const SlopedInnovations& run, double block_s) {
  const std::vector<Innovation>& innovations = run.innovations;
  std::vector<ScoreBlock> blocks;
  for (auto begin = innovations.begin(); begin != innovations.end();) {
    const auto end = std::ranges::upper_bound(begin, innovations.end(), begin->time_s + block_s, {},
                                              &Innovation::time_s);
    const auto first = static_cast<std::size_t>(begin - innovations.begin());
    const auto count = static_cast<std::size_t>(end - begin);
    const Eigen::MatrixXd instruments =
        Standardised(run, &InnovationSlope::instrument, first, count);
    blocks.push_back({OfRoot(instruments), instruments * StandardisedValues(run, first, count)});
    begin = end;
  }
  return blocks;
}

Normal NormalEquations(const Problem& problem, const SlopedRuns& all) {
  Normal normal{
      Eigen::MatrixXd::Zero(kParameters, kParameters), Eigen::VectorXd::Zero(kParameters), {}, {}};
  normal.recordings.resize(problem.dataset_.Recordings());
  for (std::size_t s = 0; s < all.size(); ++s) {
    ScoreBlock& recording = normal.recordings[problem.dataset_.RecordingOf(s)];
    for (const ScoreBlock& block : BlocksOf(all[s], problem.options_.block_s)) {
      recording.information += block.information;
      recording.score += block.score;
      normal.blocks.push_back(block);
    }
  }
  for (const ScoreBlock& recording : normal.recordings) {
    normal.information += recording.information;
    normal.gradient += recording.score;
  }
  return normal;
}

// How the data's score changes with the parameters.
Eigen::MatrixXd ScoreSlope(const SlopedRuns& all) {
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(kParameters, kParameters);
  for (const SlopedInnovations& run : all) {
    slope.noalias() += Standardised(run, &InnovationSlope::instrument) *
                       Standardised(run, &InnovationSlope::slope).transpose();
  }
  return slope;
}

// How much more the instruments say of the parameters than the slopes do, on average over them.
double StrengthOfInstruments(const SlopedRuns& all, const Normal& normal,
                             const Eigen::MatrixXd& precision_of_prior) {
  Eigen::MatrixXd of_slopes = precision_of_prior;
  for (const SlopedInnovations& run : all) {
    of_slopes += OfRoot(Standardised(run, &InnovationSlope::slope));
  }
  return of_slopes.ldlt().solve(normal.information).trace() / static_cast<double>(kParameters);
}

// One step of Fisher scoring of each recording's noise, at most a factor e; slopes by finite
// differences of log.
double ScoreNoise(const Problem& problem, const Eigen::VectorXd& z, const NoiseVector& least,
                  std::vector<NoiseModel>& noise) {
  constexpr double kStep = 0.05;
  std::vector<std::vector<NoiseModel>> moved;
  for (const NoiseModel& of_recording : noise) {
    moved.emplace_back(kNoises + 1, of_recording);
    for (Eigen::Index j = 0; j < kNoises; ++j) {
      NoiseVector log = LogOf(of_recording);
      log[j] += kStep;
      moved.back()[static_cast<std::size_t>(j) + 1] = NoiseOf(log);
    }
  }
  const std::vector<Runs> runs = problem.RunForNoise(z, moved);
  double largest_move = 0.0;
  for (std::size_t recording = 0; recording < noise.size(); ++recording) {
    const NoiseVector log = LogOf(noise[recording]);
    Eigen::MatrixXd information =
        Eigen::MatrixXd::Identity(kNoises, kNoises) / std::pow(kNoisePriorSigma, 2);
    Eigen::VectorXd gradient = (NoisePriorMean() - log) / std::pow(kNoisePriorSigma, 2);
    for (std::size_t excerpt = 0; excerpt < runs.size(); ++excerpt) {
      if (problem.RecordingOfExcerpt(excerpt) != recording) continue;
      const Runs& run = runs[excerpt];
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
    Eigen::VectorXd step = information.ldlt().solve(gradient);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > 1.0) step /= largest;
    const NoiseVector next = (log + step).cwiseMax(least).cwiseMin(GreatestNoise());
    noise[recording] = NoiseOf(next);
    largest_move = std::max(largest_move, (next - log).cwiseAbs().maxCoeff());
  }
  return largest_move;
}

// The step of damped normal equations inside the bounds: a parameter that would leave its range
// stops at the end of it.
Eigen::VectorXd BoundedStep(const Problem& problem, const Eigen::VectorXd& z,
                            const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                            double damping) {
  const Eigen::Index n = z.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
  std::vector<bool> fixed(static_cast<std::size_t>(n), false);
  for (int pass = 0; pass < 12; ++pass) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!fixed[static_cast<std::size_t>(i)]) free.push_back(i);
    Eigen::MatrixXd a(free.size(), free.size());
    Eigen::VectorXd b(free.size());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Eigen::Index fi = free[static_cast<std::size_t>(i)];
      b[i] = gradient[fi];
      for (Eigen::Index j = 0; j < n; ++j) {
        if (fixed[static_cast<std::size_t>(j)]) b[i] -= information(fi, j) * step[j];
      }
      for (Eigen::Index j = 0; j < a.cols(); ++j) {
        a(i, j) = information(fi, free[static_cast<std::size_t>(j)]);
      }
      a(i, i) *= 1.0 + damping;
    }
    const Eigen::VectorXd solved = a.partialPivLu().solve(b);
    bool again = false;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Eigen::Index fi = free[static_cast<std::size_t>(i)];
      const double to = z[fi] + solved[i];
      step[fi] = solved[i];
      if (to < problem.prior_.least[fi]) {
        step[fi] = problem.prior_.least[fi] - z[fi];
        fixed[static_cast<std::size_t>(fi)] = again = true;
      } else if (to > problem.prior_.greatest[fi]) {
        step[fi] = problem.prior_.greatest[fi] - z[fi];
        fixed[static_cast<std::size_t>(fi)] = again = true;
      }
    }
    if (!again) break;
  }
  return step;
}

double Squares(const SlopedRuns& runs) {
  double squares = 0.0;
  for (const SlopedInnovations& run : runs) {
    for (const Innovation& i : run.innovations) squares += i.value * i.value / i.variance;
  }
  return squares;
}

// Gauss-Newton steps at fixed gains, each followed by a step of the noise, until neither moves;
// then steps of the equations with instruments.
class Search {
 public:
  explicit Search(const Problem& problem)
      : problem_(&problem),
        z_(problem.FirstParameters()),
        noise_(problem.dataset_.Recordings(), FirstNoise(problem.dataset_)),
        weight_(std::min(1.0, kFirstWeightS / SpanS(problem.dataset_))) {
    if (!problem.options_.start) return;
    z_ = problem.options_.start->parameters;
    noise_.assign(noise_.size(), problem.options_.start->noise);
  }

  /// Whether there is more to do after this iteration.
  bool Iterate() {
    const SlopedRuns runs = problem_->RunWithSlopes(z_, noise_, std::nullopt);
    const auto [precision, mean, gradient] = Linearise(runs, weight_);
    slope_ = information_;
    newton_mean_ = z_ + information_.ldlt().solve(gradient);

    const auto cost = [&, this, &precision = precision, &mean = mean](const Eigen::VectorXd& z,
                                                                      double squares) {
      return weight_ * squares + (z - mean).dot(precision * (z - mean));
    };
    const double now = cost(z_, Squares(runs));
    const double nominal_fix_delay_s = z_[At(kFixDelay)];
    double moved = 0.0;
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
      const Eigen::VectorXd step = BoundedStep(*problem_, z_, information_, gradient, damping_);
      const double expected = step.dot(2.0 * gradient - information_ * step);
      const Eigen::VectorXd candidate = z_ + step;
      if (problem_->Feasible(candidate) &&
          cost(candidate, problem_->SquaresWith(runs, candidate, noise_, nominal_fix_delay_s)) <=
              now * (1.0 + kRounding)) {
        moved = std::sqrt(std::max(expected, 0.0));
        z_ = candidate;
        damping_ = std::max(0.2 * damping_, kLeastDamping);
        break;
      }
      damping_ = std::max(10.0 * damping_, kFirstDamping);
      if (expected < kNegligibleGain) break;
    }
    ++iterations_;
    if (!noise_settled_) {
      noise_settled_ = ScoreNoise(*problem_, z_, LeastNoise(), noise_) < kSettledNoise ||
                       iterations_ >= kNoiseIterations;
    }
    const bool settled = moved < kConvergedMove && noise_settled_;
    return !settled && iterations_ < problem_->options_.max_iterations;
  }

  // A step of the equations with instruments: there is no sum of squares to watch. Whether there is
  // more to do.
  bool IterateWithInstruments() {
    const SlopedRuns runs = problem_->RunWithSlopes(z_, noise_, time_constant_s_);
    const auto [precision, mean, gradient] = Linearise(runs, 1.0);
    slope_ = ScoreSlope(runs) + precision;
    newton_mean_ = z_ + slope_.partialPivLu().solve(gradient);
    const Eigen::VectorXd whole = BoundedStep(*problem_, z_, slope_, gradient, 0.0);
    const Eigen::VectorXd score = slope_ * whole;
    const double left = InStandardErrors(score);
    if (solution_iterations_ == 0) first_left_ = left;
    if (!std::isfinite(left) || IsAstray(left)) return false;
    // A boat of the instruments that does not stay near moves far, and all rests on where it does.
    if (!(StrengthOfInstruments(runs, normal_, precision) < kGreatestStrength)) return false;
    instrumented_ = left < kConvergedScore || ChangesSignAlongStep(score);
    // Weights and order of the readings change with the parameters: a whole step may go to and fro.
    if (left > kSlow * left_) caution_ = std::min(2.0 * caution_ + 0.25, kMostCaution);
    if (left < kQuick * left_) caution_ *= 0.5;
    left_ = left;
    Eigen::VectorXd step =
        BoundedStep(*problem_, z_, slope_ + caution_ * information_, gradient, 0.0);
    while (!problem_->Feasible(z_ + step) && step.squaredNorm() > 0.0) step *= 0.5;
    z_ += step;
    step_ = step;
    score_ = score;
    ++instrument_iterations_;
    return !instrumented_ && ++solution_iterations_ < kInstrumentIterations;
  }

  // From now on the noise is that of a boat of the instruments that follows.
  void SettleNoiseWhereFollowing() {
    for (int i = 0; i < kNoiseIterations; ++i) {
      if (ScoreNoise(*problem_, z_, LeastNoiseWhereFollowing(), noise_) < kSettledNoise) break;
    }
  }

  // From now on all of the data count. Whether they did not before.
  bool CountAllData() {
    if (weight_ == 1.0) return false;
    weight_ = 1.0;
    damping_ = kFirstDamping;
    iterations_before_ += std::exchange(iterations_, 0);
    return true;
  }

  // From now on the boat of the instruments follows with this time constant.
  void UseInstruments(double time_constant_s) {
    time_constant_s_ = time_constant_s;
    left_ = std::numeric_limits<double>::infinity();
    caution_ = 0.0;
    solution_iterations_ = 0;
    instrumented_ = false;
    step_.setZero();
  }

  bool IsInstrumented() const { return instrumented_; }

  double ShareDone() const {
    const int done = iterations_before_ + iterations_ + instrument_iterations_;
    return std::min(1.0,
                    static_cast<double>(done) /
                        static_cast<double>(problem_->options_.max_iterations +
                                            kInstrumentIterations * (1 + kFollowingSlowly.size())));
  }

  PredictionErrorFit Fit() const {
    PredictionErrorFit fit;
    fit.parameters = z_;
    fit.noise = noise_;
    fit.newton_mean = newton_mean_;
    fit.information = information_;
    fit.slope = slope_;
    fit.data_information = normal_.information;
    fit.blocks = normal_.blocks;
    fit.recordings = normal_.recordings;
    fit.innovations = innovations_;
    fit.iterations = iterations_before_ + iterations_ + instrument_iterations_;
    fit.converged = instrumented_;
    return fit;
  }

 private:
  struct Linearised {
    Eigen::MatrixXd precision;  // of the prior
    Eigen::VectorXd mean;       // of the prior
    Eigen::VectorXd gradient;   // data and prior, downwards
  };

  double InStandardErrors(const Eigen::VectorXd& score) const {
    return std::sqrt(score.dot(information_.ldlt().solve(score)));
  }

  // The score of a dead band jumps where the band passes a command that was held: the thrust beyond
  // it changes with the band, that within it does not. Such equations are solved where they change
  // sign; steps to and fro across a jump never leave less of them.
  bool ChangesSignAlongStep(const Eigen::VectorXd& score) const {
    const Eigen::VectorXd along = information_ * step_;
    const double square = step_.dot(along);
    if (!(square > 0.0 && square < kConvergedScore * kConvergedScore)) return false;
    if (score_.dot(step_) <= 0.0 || score.dot(step_) >= 0.0) return false;
    return InStandardErrors(score - along * (score.dot(step_) / square)) < kConvergedScore;
  }

  // Whether there is more left of the score than steps that lead to a solution leave.
  bool IsAstray(double left) const {
    return left > kAstray * first_left_ ||
           (solution_iterations_ >= kIterationsToHalve && left > 0.5 * first_left_ &&
            left > 2.0 * kConvergedScore);
  }

  // The equations at z_; leaves their information behind.
  Linearised Linearise(const SlopedRuns& runs, double weight) {
    normal_ = NormalEquations(*problem_, runs);
    innovations_ = 0;
    for (const SlopedInnovations& run : runs) innovations_ += run.innovations.size();
    Linearised at;
    at.precision = problem_->PriorPrecision(z_);
    at.mean = problem_->PriorShift(at.precision);
    information_ = weight * normal_.information + at.precision;
    // Innovations are readings less predictions: a step against their slope reduces them.
    at.gradient = -weight * normal_.gradient - at.precision * (z_ - at.mean);
    return at;
  }

  // With more data than this and a filter that follows the readings, the prior would be too weak to
  // keep the first steps near the boat: all data count as much as these until the noise is right.
  static constexpr double kFirstWeightS = 600.0;
  static constexpr int kMostAttempts = 8;
  static constexpr double kFirstDamping = 1e-3;
  static constexpr double kLeastDamping = 1e-9;
  static constexpr double kRounding = 1e-9;
  static constexpr double kNegligibleGain = 1e-3;  // of a sum of weighted squares
  static constexpr double kConvergedMove = 0.1;    // in standard errors, all parameters together
  // Noise as close as this serves: a wrong one costs precision alone, and steps of noise and
  // parameters in turn may go round in circles.
  static constexpr double kSettledNoise = 0.05;  // of its logarithm
  static constexpr int kNoiseIterations = 8;
  static constexpr int kInstrumentIterations = 20;
  static constexpr double kAstray = 10.0;
  static constexpr double kGreatestStrength = 10.0;
  static constexpr int kIterationsToHalve = 5;
  static constexpr double kSlow = 0.7;
  static constexpr double kQuick = 0.5;
  static constexpr double kMostCaution = 1.0;
  // A tenth of a standard error of each parameter, all together.
  static constexpr double kConvergedScore = 0.48;

  const Problem* problem_;
  Eigen::VectorXd z_;
  std::vector<NoiseModel> noise_;
  double weight_;  // of the data, the prior's being one
  double damping_ = kFirstDamping;
  Normal normal_;
  Eigen::MatrixXd information_;
  Eigen::MatrixXd slope_;
  Eigen::VectorXd newton_mean_;
  FossenVector step_ = FossenVector::Zero();   // the last one with these instruments
  FossenVector score_ = FossenVector::Zero();  // before it
  std::size_t innovations_ = 0;
  int iterations_ = 0;
  int iterations_before_ = 0;  // before all data counted
  int instrument_iterations_ = 0;
  int solution_iterations_ = 0;                            // with these instruments
  double left_ = std::numeric_limits<double>::infinity();  // of the score, in standard errors
  double first_left_ = 0.0;                                // with these instruments
  double caution_ = 0.0;
  double time_constant_s_ = kDrivenByCommandsAlone;
  bool instrumented_ = false;
  bool noise_settled_ = false;
};

}  // namespace

PredictionErrorFit FitPredictionError(const PreparedDataset& dataset, double propeller_separation_m,
                                      const FossenPrior& prior,
                                      const PredictionErrorOptions& options,
                                      const std::function<void(double share)>& progress) {
  const Problem problem(dataset, propeller_separation_m, prior, options);
  Search search(problem);
  const auto report_progress = [&] {
    if (progress) progress(search.ShareDone());
  };
  const auto fit_slopes = [&] {
    while (search.Iterate()) report_progress();
  };
  std::optional<Search> solved;
  const auto solve = [&](double time_constant_s) {
    search.UseInstruments(time_constant_s);
    while (search.IterateWithInstruments()) report_progress();
    if (search.IsInstrumented()) solved = search;
    return search.IsInstrumented();
  };
  fit_slopes();
  const Search by_slopes = search;
  if (!solve(kDrivenByCommandsAlone)) {
    search = by_slopes;
    if (options.free_instruments_only) return search.Fit();
    if (!solve(kFollowingSlowly.front())) search = by_slopes;
    search.SettleNoiseWhereFollowing();
    std::ranges::all_of(kFollowingSlowly, solve);
  }
  if (solved) return solved->Fit();
  // Where the instruments are too weak, the slopes' solution stands and counts as not converged.
  search = by_slopes;
  if (search.CountAllData()) fit_slopes();
  return search.Fit();
}

}  // namespace telltale
