#include "telltale/core/estimation/prediction_error/prediction_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/estimation/prediction_error/bounded_step.hpp"
#include "telltale/core/estimation/prediction_error/innovations.hpp"
#include "telltale/core/estimation/prediction_error/noise_scoring.hpp"
#include "telltale/core/estimation/prediction_error/normal_equations.hpp"

namespace telltale {
namespace {

using enum FossenParameter;

constexpr Eigen::Index kParameters = static_cast<Eigen::Index>(kFossenParameters);

// A boat that keeps no course by itself soon leaves the one that the commands alone drive, which
// then tells nothing of it. One that follows it slowly stays near, and is less free of what
// disturbs the boat; in s.
constexpr double kDrivenByCommandsAlone = std::numeric_limits<double>::infinity();
constexpr std::array kFollowingSlowly = {5.0, 10.0, 20.0};

// Of all segments together.
double SpanS(const PreparedDataset& dataset) {
  double span_s = 0.0;
  for (const RawSignals& signals : dataset.signals) {
    const std::vector<double>& times_s = signals.psi_rad.times_s;
    if (!times_s.empty()) span_s += times_s.back() - times_s.front();
  }
  return span_s;
}

double SquaresOf(const SlopedRuns& runs) {
  double squares = 0.0;
  for (const SlopedInnovations& run : runs) squares += WeightedSquares(run.innovations);
  return squares;
}

class Problem {
 public:
  Problem(const PreparedDataset& dataset, double separation_m, const FossenPrior& prior,
          const PredictionErrorOptions& options)
      : dataset_(dataset),
        separation_m_(separation_m),
        prior_(prior),
        options_(options),
        noise_scoring_(dataset, options.threads) {}

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

  // One step of the noise of each recording; the largest move of a logarithm.
  double ScoreNoise(const Eigen::VectorXd& z, NoiseFloor floor,
                    std::vector<NoiseModel>& noise) const {
    const auto settings_under = [&](const NoiseModel& of_recording) {
      return SettingsOf(z, of_recording, z[At(kFixDelay)]);
    };
    return noise_scoring_.Step(settings_under, floor, noise);
  }

  // The step inside the ranges of the parameters.
  Eigen::VectorXd StepFrom(const Eigen::VectorXd& z, const Eigen::MatrixXd& information,
                           const Eigen::VectorXd& gradient, double damping) const {
    return BoundedStep(z, prior_.least, prior_.greatest, information, gradient, damping);
  }

  // The sum of weighted squares at fixed gains, which the normal equations are those of.
  double SquaresWith(const SlopedRuns& runs, const Eigen::VectorXd& z,
                     const std::vector<NoiseModel>& noise, double nominal_fix_delay_s) const {
    std::vector<double> sums(dataset_.segments.size(), 0.0);
    ForEachIndex(sums.size(), options_.threads, [&](std::size_t s) {
      const FilterSettings settings =
          SettingsOf(z, noise[dataset_.RecordingOf(s)], nominal_fix_delay_s);
      sums[s] = WeightedSquares(
          InnovationsWith(runs[s].gains, dataset_.signals[s], dataset_.commands[s], settings));
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
  NoiseScoring noise_scoring_;
};

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
    const double now = cost(z_, SquaresOf(runs));
    const double nominal_fix_delay_s = z_[At(kFixDelay)];
    double moved = 0.0;
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
      const Eigen::VectorXd step = problem_->StepFrom(z_, information_, gradient, damping_);
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
      noise_settled_ = problem_->ScoreNoise(z_, NoiseFloor::kOfReadings, noise_) < kSettledNoise ||
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
    const Eigen::VectorXd whole = problem_->StepFrom(z_, slope_, gradient, 0.0);
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
    Eigen::VectorXd step = problem_->StepFrom(z_, slope_ + caution_ * information_, gradient, 0.0);
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
      if (problem_->ScoreNoise(z_, NoiseFloor::kWhereFollowing, noise_) < kSettledNoise) break;
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
    normal_ = NormalEquationsOf(runs, problem_->dataset_, problem_->options_.block_s);
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
  NormalEquations normal_;
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
