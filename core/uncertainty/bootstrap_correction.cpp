#include "telltale/core/uncertainty/bootstrap_correction.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/uncertainty/fit_simulation.hpp"
#include "telltale/core/uncertainty/interval_calibration.hpp"
#include "telltale/core/uncertainty/sensor_residuals.hpp"
#include "telltale/core/uncertainty/shrinkage_search.hpp"
#include "telltale/core/uncertainty/whitening.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

bool IsUsable(const BootstrapCorrection& correction) {
  return correction.theta.allFinite() && correction.covariance.allFinite() &&
         (correction.covariance.diagonal().array() > 0.0).all() &&
         correction.interval_factors.allFinite() &&
         std::isfinite(correction.joint.covariance_factor);
}

std::uint64_t SeedOf(const BootstrapCorrectionOptions& bootstrap, std::size_t replicate) {
  return RandomEngine::Stream(bootstrap.seed, replicate)();
}

/// Undisturbed replicates draw from the streams that follow those of the replicates.
ReplicateSensors SensorsOf(const BootstrapCorrectionOptions& bootstrap) {
  ReplicateSensors sensors{bootstrap.noise_scale, {}, bootstrap.threads};
  for (std::size_t i = 0; i < sensors.seeds.size(); ++i) {
    sensors.seeds[i] = SeedOf(bootstrap, bootstrap.parametric_replicates + i);
  }
  return sensors;
}

/// Counts finished replicates. The fraction never falls where the work starts again.
class ReplicateProgress {
 public:
  ReplicateProgress(std::size_t replicates, const std::function<void(double)>& progress)
      : replicates_(replicates), progress_(progress) {}

  void Restart() { done_ = 0; }

  void AddOne() {
    const std::lock_guard lock(mutex_);
    ++done_;
    const double fraction = static_cast<double>(done_) / static_cast<double>(replicates_);
    if (fraction <= reported_) return;
    reported_ = fraction;
    if (progress_) progress_(fraction);
  }

 private:
  const std::size_t replicates_;
  const std::function<void(double)>& progress_;
  std::mutex mutex_;
  std::size_t done_ = 0;
  double reported_ = 0.0;
};

/// The part of the bias that the data determine, P Sigma^-1 bias in each block with P the
/// posterior's and Sigma the clusters' covariance. Along ill-determined directions the bias depends
/// on the drawn models, which differ from the true one.
Eigen::VectorXd ShrunkBias(const Eigen::VectorXd& bias, const Eigen::MatrixXd& posterior_covariance,
                           const Eigen::MatrixXd& cluster_covariance,
                           const std::vector<Block>& blocks) {
  Eigen::VectorXd shrunk(bias.size());
  for (const auto& [begin, size] : blocks) {
    const Eigen::MatrixXd clustered = cluster_covariance.block(begin, begin, size, size);
    const Eigen::VectorXd of_block = bias.segment(begin, size);
    const Eigen::VectorXd whitened = clustered.ldlt().solve(of_block);
    shrunk.segment(begin, size) = posterior_covariance.block(begin, begin, size, size) * whitened;
  }
  return shrunk;
}

/// Draws, simulates and estimates replicates, and corrects the fit by their errors.
class BootstrapCorrector {
 public:
  BootstrapCorrector(const FittedData& fitted,
                     const std::array<std::vector<std::size_t>, 3>& columns,
                     const BootstrapCorrectionOptions& bootstrap,
                     const std::function<void(double)>& progress)
      : fitted_(fitted),
        columns_(columns),
        bootstrap_(bootstrap),
        clustered_(ClusterCovariance(fitted.fit)),
        blocks_(fitted.fit.Blocks()),
        white_(clustered_, blocks_),
        progress_(bootstrap.parametric_replicates, progress) {}

  std::optional<BootstrapCorrection> CorrectBy(const SimulablePosterior& simulable) {
    const WeakFit& fit = fitted_.fit;
    const RidgePosterior& posterior = simulable.posterior;
    BootstrapCorrection correction;
    correction.disturbance =
        EstimateDisturbance(fitted_.dataset, fit, simulable.sensor_autocovariances);
    Disturbance disturbance = correction.disturbance;
    disturbance.time_constant_s *= bootstrap_.time_scale;
    const auto replicate_errors = EstimateReplicates(posterior, disturbance);
    if (2 * replicate_errors.size() < bootstrap_.parametric_replicates) return std::nullopt;
    correction.solved = replicate_errors.size();
    correction.failures = bootstrap_.parametric_replicates - replicate_errors.size();
    correction.degrees_of_freedom = static_cast<double>(fit.scores.cols()) - 1.0;
    const auto calibration =
        CalibrateIntervals(replicate_errors, white_.map, blocks_, correction.degrees_of_freedom);
    if (!calibration) return std::nullopt;
    correction.theta =
        fit.theta - ShrunkBias(calibration->bias, posterior.covariance, clustered_, blocks_);
    correction.covariance = Mapped(calibration->scale, white_.Of(clustered_));
    correction.interval_factors = calibration->interval_factors;
    correction.joint = {calibration->covariance_factor, correction.degrees_of_freedom};
    if (!IsUsable(correction)) return std::nullopt;
    return correction;
  }

 private:
  /// Each replicate draws a plausible model of its own. A bias that depends on ill-determined
  /// coefficients then shows as scatter.
  std::vector<ReplicateError> EstimateReplicates(const RidgePosterior& posterior,
                                                 const Disturbance& disturbance) {
    const Eigen::VectorXd& mean = posterior.posterior_mean;
    const Whitening plausible(posterior.covariance, {{0, mean.size()}});
    std::vector<std::optional<ReplicateError>> all(bootstrap_.parametric_replicates);
    progress_.Restart();
    ForEachIndex(all.size(), bootstrap_.threads, [&](std::size_t i) {
      RandomEngine engine(SeedOf(bootstrap_, i));
      boost::random::normal_distribution<double> normal;
      Eigen::VectorXd off(mean.size());
      for (double& value : off) value = normal(engine);
      all[i] = EstimateReplicate(mean, plausible.map * off, disturbance, engine());
      progress_.AddOne();
    });
    std::vector<ReplicateError> estimated;
    for (auto& replicate_error : all) {
      if (replicate_error) estimated.push_back(*std::move(replicate_error));
    }
    return estimated;
  }

  /// The error of the first replicate that can be simulated and estimated, with models ever nearer
  /// to the mean. All of `off` makes most replicates larger than the boat, and less hides how the
  /// bias depends on the model. Where the mean itself diverges, other disturbances are tried,
  /// because the recorded boat did not diverge.
  std::optional<ReplicateError> EstimateReplicate(const Eigen::VectorXd& mean,
                                                  const Eigen::VectorXd& off,
                                                  const Disturbance& disturbance,
                                                  std::uint64_t seed) const {
    constexpr std::array<double, 8> kShares = {0.7, 0.35, 0.175, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < kShares.size(); ++i) {
      const bool repeats_the_mean = i > 0 && kShares[i] == kShares[i - 1];
      if (repeats_the_mean) seed = RandomEngine::Stream(seed, i)();
      Eigen::VectorXd truth = mean + kShares[i] * off;
      if (fitted_.fit.time_constant_s) truth[0] = std::max(truth[0], kShortestTimeConstantS);
      const auto replicate = SimulateFit(fitted_, truth, disturbance, bootstrap_.noise_scale, seed);
      if (!replicate) continue;
      const auto again = EstimateWeakIv(*replicate, fitted_.regression, columns_, fitted_.options);
      if (!again) continue;
      ReplicateError replicate_error{white_.inverse * (again->theta - truth),
                                     white_.Of(ClusterCovariance(*again))};
      if (IsUsable(replicate_error)) return replicate_error;
    }
    return std::nullopt;
  }

  const FittedData& fitted_;
  const std::array<std::vector<std::size_t>, 3>& columns_;
  const BootstrapCorrectionOptions& bootstrap_;
  const Eigen::MatrixXd clustered_;
  const std::vector<Block> blocks_;
  const Whitening white_;
  ReplicateProgress progress_;
};

}  // namespace

std::optional<BootstrapCorrection> CorrectByParametricBootstrap(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const BootstrapCorrectionOptions& bootstrap,
    const std::function<void(double fraction)>& progress) {
  Require(bootstrap.parametric_replicates >= 8, "at least eight parametric bootstrap replicates");
  const FittedData fitted{dataset, regression, options, fit};
  BootstrapCorrector corrector(fitted, columns, bootstrap, progress);
  return FirstSimulable(fitted, SensorsOf(bootstrap), [&](const SimulablePosterior& simulable) {
    return corrector.CorrectBy(simulable);
  });
}

std::optional<Disturbance> DisturbanceFromResiduals(const PreparedDataset& dataset,
                                                    const RegressionOptions& regression,
                                                    const WeakFit& fit,
                                                    const WeakIvOptions& options,
                                                    std::uint64_t seed) {
  const FittedData fitted{dataset, regression, options, fit};
  BootstrapCorrectionOptions bootstrap;
  bootstrap.seed = seed;
  return FirstSimulable(fitted, SensorsOf(bootstrap), [&](const SimulablePosterior& simulable) {
    return std::optional<Disturbance>(
        EstimateDisturbance(dataset, fit, simulable.sensor_autocovariances));
  });
}

}  // namespace telltale
