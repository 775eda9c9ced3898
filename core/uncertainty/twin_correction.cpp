#include "telltale/core/uncertainty/twin_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <mutex>
#include <utility>

#include <boost/random/normal_distribution.hpp>

#include "telltale/core/contract.hpp"
#include "telltale/core/estimation/disturbance.hpp"
#include "telltale/core/estimation/residual_correlation.hpp"
#include "telltale/core/linear_algebra/covariance.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"
#include "telltale/core/parallel.hpp"
#include "telltale/core/random.hpp"
#include "telltale/core/simulation/dataset_twin.hpp"
#include "telltale/core/uncertainty/twin_calibration.hpp"

namespace telltale {
namespace {

constexpr std::size_t kQuietTwins = 2;
// Large beside sensor noise, so that little chance is left in what wandering fixes leave.
constexpr double kUnitWanderM = 0.03;
// Of the expected distance of the truth from the estimate: how plain the boats are that are
// sailed. Plainer ones are less wild than the truth may be, and tell of another bias.
constexpr double kReaches[] = {0.1, 0.5, 2.0, 8.0, 32.0, 128.0};
constexpr int kPlainnesses = static_cast<int>(std::size(kReaches)) + 1;

bool IsSound(const TwinCorrection& correction) {
  return correction.theta.allFinite() && correction.covariance.allFinite() &&
         (correction.covariance.diagonal().array() > 0.0).all() &&
         correction.interval_factors.allFinite() &&
         std::isfinite(correction.joint.covariance_factor);
}

/// Coordinates in which the errors of each block are uncorrelated and of size one: x = map z. The
/// axes are those of the correlations, so that units make no difference, and never of two blocks:
/// one that the data hardly move would lend its size to the others.
struct Whitening {
  Whitening(const Eigen::MatrixXd& covariance, const std::vector<Block>& blocks)
      : map(Eigen::MatrixXd::Zero(covariance.rows(), covariance.cols())), inverse(map) {
    const Eigen::VectorXd sizes = covariance.diagonal().cwiseMax(kSmallest).cwiseSqrt();
    const Eigen::MatrixXd correlation = Scaled(covariance, sizes.cwiseInverse());
    for (const auto& [begin, size] : blocks) {
      const Eigen::MatrixXd within = correlation.block(begin, begin, size, size);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(within);
      const Eigen::VectorXd lengths = axes.eigenvalues().cwiseMax(kSmallest).cwiseSqrt();
      const auto of_block = sizes.segment(begin, size);
      map.block(begin, begin, size, size) =
          of_block.asDiagonal() * axes.eigenvectors() * lengths.asDiagonal();
      inverse.block(begin, begin, size, size) = lengths.cwiseInverse().asDiagonal() *
                                                axes.eigenvectors().transpose() *
                                                of_block.cwiseInverse().asDiagonal();
    }
  }

  Eigen::MatrixXd Of(const Eigen::MatrixXd& covariance) const {
    return Mapped(inverse, covariance);
  }

  static constexpr double kSmallest = 1e-14;
  Eigen::MatrixXd map;
  Eigen::MatrixXd inverse;
};

class TwinFleet {
 public:
  TwinFleet(const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
            const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
            const TwinCorrectionOptions& twins, const std::function<void(double)>& progress)
      : dataset_(dataset),
        regression_(regression),
        fit_(fit),
        columns_(columns),
        options_(options),
        twins_(twins),
        progress_(progress),
        clustered_(ClusterCovariance(fit)),
        blocks_(fit.Blocks()),
        white_(clustered_, blocks_) {}

  std::optional<Disturbance> DisturbanceAlone() const {
    return BySailable([this](const Sailable& sailable) {
      return std::optional<Disturbance>(JudgeDisturbance(sailable));
    });
  }

  /// By boats as much plainer than the estimate as it takes for most twins not to run away.
  std::optional<TwinCorrection> Run() {
    return BySailable([this](const Sailable& sailable) { return CorrectBy(sailable); });
  }

 private:
  /// Boats that can be sailed, and what the middle one gives in still water, by fixes that stay and
  /// by fixes that wander.
  struct Sailable {
    PlausibleBoats boats;
    std::vector<PreparedDataset> quiet;
    std::vector<PreparedDataset> wandering;
  };

  /// Plausible boats, each plainer than the one before; in the end the damped one alone.
  PlausibleBoats BoatsOf(int plainness) const {
    if (plainness < std::ssize(kReaches)) return PlausibleAbout(fit_, kReaches[plainness]);
    const Eigen::Index P = fit_.theta.size();
    return {fit_.Damped(), Eigen::MatrixXd::Zero(P, P)};
  }

  /// What `answer` makes of the least plain boats that can be sailed and that it has an answer for.
  template <class Answer>
  auto BySailable(const Answer& answer) const -> decltype(answer(std::declval<const Sailable&>())) {
    for (int plainness = 0; plainness < kPlainnesses; ++plainness) {
      const auto sailable = SailQuietly(BoatsOf(plainness));
      if (!sailable) continue;
      if (auto answered = answer(*sailable)) return answered;
    }
    return std::nullopt;
  }

  std::optional<TwinCorrection> CorrectBy(const Sailable& sailable) {
    TwinCorrection correction;
    correction.disturbance = JudgeDisturbance(sailable);
    disturbance_ = correction.disturbance;
    disturbance_.time_constant_s *= twins_.time_scale;
    const auto sightings = Sight(sailable.boats);
    if (2 * sightings.size() < twins_.twins) return std::nullopt;
    correction.solved = sightings.size();
    correction.failures = twins_.twins - sightings.size();
    correction.degrees_of_freedom = static_cast<double>(fit_.scores.cols()) - 1.0;
    const auto calibration =
        Calibrate(sightings, white_.map, blocks_, correction.degrees_of_freedom);
    if (!calibration) return std::nullopt;
    correction.theta = fit_.theta - Believed(calibration->bias, sailable.boats);
    correction.covariance = Mapped(calibration->scale, white_.Of(clustered_));
    correction.interval_factors = calibration->interval_factors;
    correction.joint = {calibration->covariance_factor, correction.degrees_of_freedom};
    if (!IsSound(correction)) return std::nullopt;
    return correction;
  }

  std::optional<Sailable> SailQuietly(const PlausibleBoats& boats) const {
    Disturbance wander;
    wander.fix_wander_m = kUnitWanderM;
    Sailable found{boats, std::vector<PreparedDataset>(kQuietTwins),
                   std::vector<PreparedDataset>(kQuietTwins)};
    std::array<bool, 2 * kQuietTwins> sailed{};
    ForEachIndex(sailed.size(), twins_.threads, [&](std::size_t i) {
      const bool wanders = i >= kQuietTwins;
      const std::size_t at = i % kQuietTwins;
      auto twin = Sail(boats.middle, wanders ? wander : Disturbance(), SeedOf(twins_.twins + at));
      if (!twin) return;
      (wanders ? found.wandering : found.quiet)[at] = *std::move(twin);
      sailed[i] = true;
    });
    if (!std::all_of(sailed.begin(), sailed.end(), std::identity())) return std::nullopt;
    return found;
  }

  Result<PreparedDataset> Sail(const Eigen::VectorXd& theta, const Disturbance& disturbance,
                               std::uint64_t seed) const {
    return SailAgain(dataset_, ModelOf(fit_, theta, dataset_.sampling_period_s),
                     {disturbance, twins_.noise_scale, seed, Unanswered(), SteadyOf(fit_, theta)});
  }

  /// What the residuals show beyond what sensors alone leave in still water.
  Disturbance JudgeDisturbance(const Sailable& sailable) const {
    LeftBySensors by_sensors;
    by_sensors.noise = LeftBy(sailable.boats.middle, sailable.quiet);
    by_sensors.wander = LeftBy(sailable.boats.middle, sailable.wandering);
    for (std::size_t j = 0; j < by_sensors.wander.size(); ++j) {
      by_sensors.wander[j] -= by_sensors.noise[j];
      by_sensors.wander[j] /= kUnitWanderM * kUnitWanderM;
    }
    return EstimateDisturbance(dataset_, fit_, by_sensors);
  }

  /// Autocovariances of the residuals that `theta` leaves in its own twins, their mean.
  std::array<Eigen::VectorXd, 3> LeftBy(const Eigen::VectorXd& theta,
                                        const std::vector<PreparedDataset>& sailed) const {
    std::array<Eigen::VectorXd, 3> left = LeftBySensors().noise;
    for (const PreparedDataset& twin : sailed) {
      const WeakProblem problem = BuildWeakForm(twin, regression_, options_.form);
      const auto residuals = ResidualsOf(fit_, theta, twin, problem);
      for (std::size_t j = 0; j < left.size(); ++j) {
        if (residuals[j].size() == 0) continue;
        const auto runs = RunsOf(problem.windows[j].first_rows, problem.phi.stride);
        left[j] += Autocovariance(runs, residuals[j], kDisturbanceLags) /
                   static_cast<double>(sailed.size());
      }
    }
    return left;
  }

  std::array<bool, 3> Unanswered() const {
    return {!fit_.equations[0], !fit_.equations[1], !fit_.equations[2]};
  }

  std::uint64_t SeedOf(std::size_t twin) const { return RandomEngine::Stream(twins_.seed, twin)(); }

  /// Twins are different boats, each as plausible as the next: what the bias owes to coefficients
  /// that the data leave open then shows as scatter.
  std::vector<Sighting> Sight(const PlausibleBoats& boats) {
    const Whitening plausible(boats.covariance, {{0, boats.middle.size()}});
    std::vector<std::optional<Sighting>> all(twins_.twins);
    done_ = 0;
    ForEachIndex(all.size(), twins_.threads, [&](std::size_t i) {
      RandomEngine engine(SeedOf(i));
      boost::random::normal_distribution<double> normal;
      Eigen::VectorXd off(boats.middle.size());
      for (double& value : off) value = normal(engine);
      all[i] = SightOne(boats.middle, plausible.map * off, engine());
      Tell();
    });
    std::vector<Sighting> seen;
    for (auto& sighting : all) {
      if (sighting) seen.push_back(*std::move(sighting));
    }
    return seen;
  }

  /// The boat off the middle by half the variance of `off`, or nearer as it takes not to run away:
  /// all of it makes most twins wilder than the boat, less hides how bias depends on the boat.
  /// Where the middle itself is pushed off, pushes that the boat, which was seen, can have had are
  /// sought.
  std::optional<Sighting> SightOne(const Eigen::VectorXd& middle, const Eigen::VectorXd& off,
                                   std::uint64_t seed) const {
    constexpr std::array<double, 8> kShares = {0.7, 0.35, 0.175, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < kShares.size(); ++i) {
      const bool again_in_the_middle = i > 0 && kShares[i] == kShares[i - 1];
      if (again_in_the_middle) seed = RandomEngine::Stream(seed, i)();
      Eigen::VectorXd truth = middle + kShares[i] * off;
      if (fit_.time_constant_s) truth[0] = std::max(truth[0], kLeastTimeConstantS);
      const auto twin = Sail(truth, disturbance_, seed);
      if (!twin) continue;
      const auto again = EstimateWeakIv(*twin, regression_, columns_, options_);
      if (!again) continue;
      Sighting sighting{white_.inverse * (again->theta - truth),
                        white_.Of(ClusterCovariance(*again))};
      if (IsSound(sighting)) return sighting;
    }
    return std::nullopt;
  }

  /// Of a bias that the twins show, as much as the data tell which boat it is the bias of: along
  /// what they leave open it depends on boats that are plainer or wilder than the true one.
  Eigen::VectorXd Believed(const Eigen::VectorXd& bias, const PlausibleBoats& boats) const {
    Eigen::VectorXd believed(bias.size());
    for (const auto& [begin, size] : blocks_) {
      const Eigen::MatrixXd clustered = clustered_.block(begin, begin, size, size);
      const Eigen::VectorXd shown = bias.segment(begin, size);
      const Eigen::VectorXd weighed = clustered.ldlt().solve(shown);
      believed.segment(begin, size) = boats.covariance.block(begin, begin, size, size) * weighed;
    }
    return believed;
  }

  /// Nothing of what has been told before, where it starts again.
  void Tell() {
    const std::lock_guard lock(telling_);
    ++done_;
    const double fraction = static_cast<double>(done_) / static_cast<double>(twins_.twins);
    if (fraction <= told_) return;
    told_ = fraction;
    if (progress_) progress_(fraction);
  }

  const PreparedDataset& dataset_;
  const RegressionOptions& regression_;
  const WeakFit& fit_;
  const std::array<std::vector<std::size_t>, 3>& columns_;
  const WeakIvOptions& options_;
  const TwinCorrectionOptions& twins_;
  const std::function<void(double)>& progress_;
  Eigen::MatrixXd clustered_;
  std::vector<Block> blocks_;
  Whitening white_;
  Disturbance disturbance_;
  std::mutex telling_;
  std::size_t done_ = 0;
  double told_ = 0.0;
};

}  // namespace

std::optional<TwinCorrection> CorrectWithTwins(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const TwinCorrectionOptions& twins, const std::function<void(double fraction)>& progress) {
  Require(twins.twins >= 8, "at least eight twins");
  return TwinFleet(dataset, regression, fit, columns, options, twins, progress).Run();
}

std::optional<Disturbance> JudgeDisturbance(const PreparedDataset& dataset,
                                            const RegressionOptions& regression, const WeakFit& fit,
                                            const std::array<std::vector<std::size_t>, 3>& columns,
                                            const WeakIvOptions& options, std::uint64_t seed) {
  TwinCorrectionOptions twins;
  twins.seed = seed;
  return TwinFleet(dataset, regression, fit, columns, options, twins, {}).DisturbanceAlone();
}

}  // namespace telltale
