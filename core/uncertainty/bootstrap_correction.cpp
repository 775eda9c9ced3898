#include "telltale/core/uncertainty/bootstrap_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <mutex>
#include <utility>

#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/estimation/regression/residual_autocovariance.hpp"
#include "telltale/core/estimation/weak_form/disturbance_estimate.hpp"
#include "telltale/core/simulation/synthetic_dataset.hpp"
#include "telltale/core/uncertainty/interval_calibration.hpp"

namespace telltale {
namespace {

constexpr std::size_t kUndisturbedReplicates = 2;
// Large beside sensor noise, so that little chance is left in what wandering fixes leave.
constexpr double kUnitDriftM = 0.03;
// Of the expected distance of the truth from the estimate: how plain the boats are that are
// sailed. Plainer ones are less wild than the truth may be, and tell of another bias.
constexpr double kPriorScales[] = {0.1, 0.5, 2.0, 8.0, 32.0, 128.0};
constexpr int kShrinkageLevels = static_cast<int>(std::size(kPriorScales)) + 1;

bool IsUsable(const BootstrapCorrection& correction) {
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

class BootstrapCorrector {
 public:
  BootstrapCorrector(const PreparedDataset& dataset, const RegressionOptions& regression,
                     const WeakFit& fit, const std::array<std::vector<std::size_t>, 3>& columns,
                     const WeakIvOptions& options,
                     const BootstrapCorrectionOptions& parametric_replicates,
                     const std::function<void(double)>& progress)
      : dataset_(dataset),
        regression_(regression),
        fit_(fit),
        columns_(columns),
        options_(options),
        bootstrap_(parametric_replicates),
        progress_(progress),
        clustered_(ClusterCovariance(fit)),
        blocks_(fit.Blocks()),
        white_(clustered_, blocks_) {}

  std::optional<Disturbance> DisturbanceOnly() const {
    return WithSimulableBoats([this](const SimulableBoats& simulable) {
      return std::optional<Disturbance>(DisturbanceFromResiduals(simulable));
    });
  }

  /// By boats as much plainer than the estimate as it takes for most twins not to run away.
  std::optional<BootstrapCorrection> Run() {
    return WithSimulableBoats(
        [this](const SimulableBoats& simulable) { return CorrectBy(simulable); });
  }

 private:
  /// Boats that can be sailed, and what the middle one gives in still water, by fixes that stay and
  /// by fixes that wander.
  struct SimulableBoats {
    RidgePosterior boats;
    std::vector<PreparedDataset> undisturbed;
    std::vector<PreparedDataset> with_drift;
  };

  /// Plausible boats, each plainer than the one before; in the end the damped one alone.
  RidgePosterior BoatsOf(int shrinkage_level) const {
    if (shrinkage_level < std::ssize(kPriorScales))
      return RidgePosteriorOf(fit_, kPriorScales[shrinkage_level]);
    const Eigen::Index P = fit_.theta.size();
    return {fit_.Regularised(), Eigen::MatrixXd::Zero(P, P)};
  }

  /// What `answer` makes of the least plain boats that can be sailed and that it has an answer for.
  template <class Answer>
  auto WithSimulableBoats(const Answer& estimate) const
      -> decltype(estimate(std::declval<const SimulableBoats&>())) {
    for (int shrinkage_level = 0; shrinkage_level < kShrinkageLevels; ++shrinkage_level) {
      const auto simulable = SimulateUndisturbed(BoatsOf(shrinkage_level));
      if (!simulable) continue;
      if (auto estimated = estimate(*simulable)) return estimated;
    }
    return std::nullopt;
  }

  std::optional<BootstrapCorrection> CorrectBy(const SimulableBoats& simulable) {
    BootstrapCorrection correction;
    correction.disturbance = DisturbanceFromResiduals(simulable);
    disturbance_ = correction.disturbance;
    disturbance_.time_constant_s *= bootstrap_.time_scale;
    const auto replicate_errors = EstimateReplicates(simulable.boats);
    if (2 * replicate_errors.size() < bootstrap_.parametric_replicates) return std::nullopt;
    correction.solved = replicate_errors.size();
    correction.failures = bootstrap_.parametric_replicates - replicate_errors.size();
    correction.degrees_of_freedom = static_cast<double>(fit_.scores.cols()) - 1.0;
    const auto calibration =
        CalibrateIntervals(replicate_errors, white_.map, blocks_, correction.degrees_of_freedom);
    if (!calibration) return std::nullopt;
    correction.theta = fit_.theta - ShrunkBias(calibration->bias, simulable.boats);
    correction.covariance = Mapped(calibration->scale, white_.Of(clustered_));
    correction.interval_factors = calibration->interval_factors;
    correction.joint = {calibration->covariance_factor, correction.degrees_of_freedom};
    if (!IsUsable(correction)) return std::nullopt;
    return correction;
  }

  std::optional<SimulableBoats> SimulateUndisturbed(const RidgePosterior& boats) const {
    Disturbance drift;
    drift.gnss_drift_m = kUnitDriftM;
    SimulableBoats found{boats, std::vector<PreparedDataset>(kUndisturbedReplicates),
                         std::vector<PreparedDataset>(kUndisturbedReplicates)};
    std::array<bool, 2 * kUndisturbedReplicates> simulated{};
    ForEachIndex(simulated.size(), bootstrap_.threads, [&](std::size_t i) {
      const bool drifts = i >= kUndisturbedReplicates;
      const std::size_t at = i % kUndisturbedReplicates;
      auto replicate = Simulate(boats.posterior_mean, drifts ? drift : Disturbance(),
                                SeedOf(bootstrap_.parametric_replicates + at));
      if (!replicate) return;
      (drifts ? found.with_drift : found.undisturbed)[at] = *std::move(replicate);
      simulated[i] = true;
    });
    if (!std::all_of(simulated.begin(), simulated.end(), std::identity())) return std::nullopt;
    return found;
  }

  Result<PreparedDataset> Simulate(const Eigen::VectorXd& theta, const Disturbance& disturbance,
                                   std::uint64_t seed) const {
    return SimulateDataset(dataset_, ModelOf(fit_, theta, dataset_.sampling_period_s),
                           {disturbance, bootstrap_.noise_scale, seed, NotEstimated(),
                            ConstantDisturbancesOf(fit_, theta)});
  }

  /// What the residuals show beyond what sensors alone leave in still water.
  Disturbance DisturbanceFromResiduals(const SimulableBoats& simulable) const {
    SensorAutocovariances sensor_autocovariances;
    sensor_autocovariances.noise =
        ResidualAutocovariance(simulable.boats.posterior_mean, simulable.undisturbed);
    sensor_autocovariances.drift =
        ResidualAutocovariance(simulable.boats.posterior_mean, simulable.with_drift);
    for (std::size_t j = 0; j < sensor_autocovariances.drift.size(); ++j) {
      sensor_autocovariances.drift[j] -= sensor_autocovariances.noise[j];
      sensor_autocovariances.drift[j] /= kUnitDriftM * kUnitDriftM;
    }
    return EstimateDisturbance(dataset_, fit_, sensor_autocovariances);
  }

  /// Autocovariances of the residuals that `theta` leaves in its own twins, their mean.
  std::array<Eigen::VectorXd, 3> ResidualAutocovariance(
      const Eigen::VectorXd& theta, const std::vector<PreparedDataset>& simulated) const {
    std::array<Eigen::VectorXd, 3> autocovariance = SensorAutocovariances().noise;
    for (const PreparedDataset& replicate : simulated) {
      const WeakProblem problem = BuildWeakForm(replicate, regression_, options_.form);
      const auto residuals = ResidualsOf(fit_, theta, replicate, problem);
      for (std::size_t j = 0; j < autocovariance.size(); ++j) {
        if (residuals[j].size() == 0) continue;
        const auto runs = RunsOf(problem.supports[j].first_rows, problem.phi.stride);
        autocovariance[j] += Autocovariance(runs, residuals[j], kDisturbanceLags) /
                             static_cast<double>(simulated.size());
      }
    }
    return autocovariance;
  }

  std::array<bool, 3> NotEstimated() const {
    return {!fit_.equations[0], !fit_.equations[1], !fit_.equations[2]};
  }

  std::uint64_t SeedOf(std::size_t replicate) const {
    return RandomEngine::Stream(bootstrap_.seed, replicate)();
  }

  /// Twins are different boats, each as plausible as the next: what the bias owes to coefficients
  /// that the data leave open then shows as scatter.
  std::vector<ReplicateError> EstimateReplicates(const RidgePosterior& boats) {
    const Whitening plausible(boats.covariance, {{0, boats.posterior_mean.size()}});
    std::vector<std::optional<ReplicateError>> all(bootstrap_.parametric_replicates);
    done_ = 0;
    ForEachIndex(all.size(), bootstrap_.threads, [&](std::size_t i) {
      RandomEngine engine(SeedOf(i));
      boost::random::normal_distribution<double> normal;
      Eigen::VectorXd off(boats.posterior_mean.size());
      for (double& value : off) value = normal(engine);
      all[i] = EstimateReplicate(boats.posterior_mean, plausible.map * off, engine());
      Report();
    });
    std::vector<ReplicateError> seen;
    for (auto& replicate_error : all) {
      if (replicate_error) seen.push_back(*std::move(replicate_error));
    }
    return seen;
  }

  /// The boat off the middle by half the variance of `off`, or nearer as it takes not to run away:
  /// all of it makes most twins wilder than the boat, less hides how bias depends on the boat.
  /// Where the middle itself is pushed off, pushes that the boat, which was seen, can have had are
  /// sought.
  std::optional<ReplicateError> EstimateReplicate(const Eigen::VectorXd& posterior_mean,
                                                  const Eigen::VectorXd& off,
                                                  std::uint64_t seed) const {
    constexpr std::array<double, 8> kShares = {0.7, 0.35, 0.175, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < kShares.size(); ++i) {
      const bool repeats_the_mean = i > 0 && kShares[i] == kShares[i - 1];
      if (repeats_the_mean) seed = RandomEngine::Stream(seed, i)();
      Eigen::VectorXd truth = posterior_mean + kShares[i] * off;
      if (fit_.time_constant_s) truth[0] = std::max(truth[0], kShortestTimeConstantS);
      const auto replicate = Simulate(truth, disturbance_, seed);
      if (!replicate) continue;
      const auto again = EstimateWeakIv(*replicate, regression_, columns_, options_);
      if (!again) continue;
      ReplicateError replicate_error{white_.inverse * (again->theta - truth),
                                     white_.Of(ClusterCovariance(*again))};
      if (IsUsable(replicate_error)) return replicate_error;
    }
    return std::nullopt;
  }

  /// Of a bias that the twins show, as much as the data tell which boat it is the bias of: along
  /// what they leave open it depends on boats that are plainer or wilder than the true one.
  Eigen::VectorXd ShrunkBias(const Eigen::VectorXd& bias, const RidgePosterior& boats) const {
    Eigen::VectorXd shrunk(bias.size());
    for (const auto& [begin, size] : blocks_) {
      const Eigen::MatrixXd clustered = clustered_.block(begin, begin, size, size);
      const Eigen::VectorXd shown = bias.segment(begin, size);
      const Eigen::VectorXd whitened = clustered.ldlt().solve(shown);
      shrunk.segment(begin, size) = boats.covariance.block(begin, begin, size, size) * whitened;
    }
    return shrunk;
  }

  /// Nothing of what has been told before, where it starts again.
  void Report() {
    const std::lock_guard lock(reporting_);
    ++done_;
    const double fraction =
        static_cast<double>(done_) / static_cast<double>(bootstrap_.parametric_replicates);
    if (fraction <= reported_) return;
    reported_ = fraction;
    if (progress_) progress_(fraction);
  }

  const PreparedDataset& dataset_;
  const RegressionOptions& regression_;
  const WeakFit& fit_;
  const std::array<std::vector<std::size_t>, 3>& columns_;
  const WeakIvOptions& options_;
  const BootstrapCorrectionOptions& bootstrap_;
  const std::function<void(double)>& progress_;
  Eigen::MatrixXd clustered_;
  std::vector<Block> blocks_;
  Whitening white_;
  Disturbance disturbance_;
  std::mutex reporting_;
  std::size_t done_ = 0;
  double reported_ = 0.0;
};

}  // namespace

std::optional<BootstrapCorrection> CorrectByParametricBootstrap(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const BootstrapCorrectionOptions& parametric_replicates,
    const std::function<void(double fraction)>& progress) {
  Require(parametric_replicates.parametric_replicates >= 8, "at least eight twins");
  return BootstrapCorrector(dataset, regression, fit, columns, options, parametric_replicates,
                            progress)
      .Run();
}

std::optional<Disturbance> DisturbanceFromResiduals(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    std::uint64_t seed) {
  BootstrapCorrectionOptions parametric_replicates;
  parametric_replicates.seed = seed;
  return BootstrapCorrector(dataset, regression, fit, columns, options, parametric_replicates, {})
      .DisturbanceOnly();
}

}  // namespace telltale
