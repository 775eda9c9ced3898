#include "uncertainty/twin_correction.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include <boost/random/normal_distribution.hpp>

#include "contract.hpp"
#include "estimation/disturbance.hpp"
#include "estimation/residual_correlation.hpp"
#include "linear_algebra/covariance.hpp"
#include "linear_algebra/decompositions.hpp"
#include "median.hpp"
#include "parallel.hpp"
#include "random.hpp"
#include "simulation/dataset_twin.hpp"
#include "uncertainty/laws.hpp"

namespace telltale {
namespace {

constexpr double kCalibratedAt = 0.95;
constexpr std::size_t kQuietTwins = 2;
// Of the expected distance of the truth from the estimate: how plain the boats are that are
// sailed. Plainer ones are less wild than the truth may be, and tell of another bias.
constexpr double kReaches[] = {0.1, 0.5, 2.0, 8.0};

/// How far one twin's estimate was off, in whitened coordinates.
struct Sighting {
  Eigen::VectorXd error;
  Eigen::MatrixXd covariance;
};

/// Whether there is anything to compare: where instruments all but vanish numbers overflow.
bool IsSound(const Sighting& sighting) {
  return sighting.error.allFinite() && sighting.covariance.allFinite() &&
         (sighting.covariance.diagonal().array() > 0.0).all();
}

bool IsSound(const TwinCorrection& correction) {
  return correction.theta.allFinite() && correction.covariance.allFinite() &&
         (correction.covariance.diagonal().array() > 0.0).all() &&
         std::isfinite(correction.joint.covariance_factor);
}

double Quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double MedianSize(std::vector<double> values, double about) {
  for (double& value : values) value = std::abs(value - about);
  return Median(std::move(values));
}

/// Weights of the twins, below one for those that lie wildly apart from the rest in any direction:
/// where instruments are weak a single twin can be off by any amount. A twin is weighed as a whole,
/// since coefficients err together: drawn in one by one they would no longer fit each other.
std::vector<double> WeighWild(const std::vector<Sighting>& sightings) {
  constexpr double kWild = 4.0;
  constexpr double kMadToSigma = 1.4826;
  std::vector<double> weights(sightings.size(), 1.0);
  for (Eigen::Index j = 0; j < sightings.front().error.size(); ++j) {
    std::vector<double> values;
    for (const Sighting& s : sightings) values.push_back(s.error[j]);
    const double middle = Median(values);
    const double reach = kWild * kMadToSigma * MedianSize(values, middle);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double off = std::abs(values[i] - middle);
      if (off > reach) weights[i] = std::min(weights[i], reach / off);
    }
  }
  return weights;
}

/// Weighed mean and standard deviation of the twins.
struct Spread {
  Eigen::VectorXd mean;
  Eigen::VectorXd sd;
};

Spread SpreadOf(const std::vector<Sighting>& sightings) {
  const std::vector<double> weights = WeighWild(sightings);
  const double n = std::accumulate(weights.begin(), weights.end(), 0.0);
  const Eigen::Index p = sightings.front().error.size();
  Spread spread{Eigen::VectorXd::Zero(p), Eigen::VectorXd::Zero(p)};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    spread.mean += weights[i] / n * sightings[i].error;
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    spread.sd += weights[i] / (n - 1.0) * (sightings[i].error - spread.mean).cwiseAbs2();
  }
  spread.sd = spread.sd.cwiseSqrt();
  return spread;
}

/// What the next value stays below with probability `share`, after few positive ones: by way of the
/// middle and the spread of their logarithms, known no better than so few tell.
double LogNormalQuantile(std::vector<double> values, double share) {
  constexpr double kMadToSigma = 1.4826;
  const auto n = static_cast<double>(values.size());
  for (double& value : values) value = std::log(value);
  const double middle = Median(values);
  const double sigma = kMadToSigma * MedianSize(values, middle);
  return std::exp(middle + sigma * std::sqrt(1.0 + 1.0 / n) * StudentQuantile(n - 1.0, share));
}

/// Unknowns that are estimated together: the time constant, the coefficients of one equation.
struct Block {
  Eigen::Index begin = 0;
  Eigen::Index size = 0;
};

std::vector<Block> BlocksOf(const WeakFit& fit) {
  std::vector<Block> blocks;
  Eigen::Index next = 0;
  const auto add = [&](Eigen::Index size) {
    blocks.push_back({next, size});
    next += size;
  };
  if (fit.time_constant_s) add(1);
  for (const auto& equation : fit.equations) {
    if (equation) add(equation->theta.size());
  }
  return blocks;
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
        blocks_(BlocksOf(fit)),
        white_(clustered_, blocks_) {}

  std::optional<Disturbance> DisturbanceAlone() const {
    const auto found = FindSailable();
    if (!found) return std::nullopt;
    return JudgeDisturbance(*found);
  }

  std::optional<TwinCorrection> Run() {
    const auto sailable = FindSailable();
    if (!sailable) return std::nullopt;
    TwinCorrection correction;
    correction.disturbance = JudgeDisturbance(*sailable);
    disturbance_ = correction.disturbance;
    disturbance_.time_constant_s *= twins_.time_scale;
    const auto sightings = Sight(sailable->boats);
    if (2 * sightings.size() < twins_.twins) return std::nullopt;
    const Spread spread = SpreadOf(sightings);
    correction.theta = fit_.theta - Believed(white_.map * spread.mean, sailable->boats);
    correction.solved = sightings.size();
    correction.failures = twins_.twins - sightings.size();
    correction.degrees_of_freedom = static_cast<double>(fit_.scores.cols()) - 1.0;
    Calibrate(sightings, spread, correction);
    if (!IsSound(correction)) return std::nullopt;
    return correction;
  }

 private:
  /// Boats that can be sailed, and what the middle one gives in still water.
  struct Sailable {
    PlausibleBoats boats;
    std::vector<PreparedDataset> quiet;
  };

  /// Plausible boats, as much plainer than the estimate as it takes not to run away; in the end the
  /// damped one alone.
  std::optional<Sailable> FindSailable() const {
    for (const double reach : kReaches) {
      auto found = SailQuietly(PlausibleAbout(fit_, reach));
      if (found) return found;
    }
    const Eigen::Index P = fit_.theta.size();
    return SailQuietly({fit_.Damped(), Eigen::MatrixXd::Zero(P, P)});
  }

  std::optional<Sailable> SailQuietly(const PlausibleBoats& boats) const {
    Sailable found{boats, {}};
    for (std::size_t i = 0; i < kQuietTwins; ++i) {
      auto quiet = Sail(boats.middle, {}, SeedOf(twins_.twins + i));
      if (!quiet) return std::nullopt;
      found.quiet.push_back(*std::move(quiet));
    }
    return found;
  }

  Result<PreparedDataset> Sail(const Eigen::VectorXd& theta, const Disturbance& disturbance,
                               std::uint64_t seed) const {
    return SailAgain(dataset_, ModelOf(fit_, theta, dataset_.sampling_period_s),
                     {disturbance, twins_.noise_scale, seed, Unanswered(), SteadyOf(fit_, theta)});
  }

  /// What the residuals show beyond what sensors alone leave in still water.
  Disturbance JudgeDisturbance(const Sailable& sailable) const {
    std::array<Eigen::VectorXd, 3> by_sensors;
    by_sensors.fill(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kDisturbanceLags)));
    for (const PreparedDataset& quiet : sailable.quiet) {
      const WeakProblem problem = BuildWeakForm(quiet, regression_, options_.form);
      const auto residuals = ResidualsOf(fit_, sailable.boats.middle, quiet, problem);
      for (std::size_t j = 0; j < 3; ++j) {
        if (residuals[j].size() == 0) continue;
        const auto runs = RunsOf(problem.windows[j].first_rows, problem.phi.stride);
        by_sensors[j] +=
            Autocovariance(runs, residuals[j], kDisturbanceLags) / static_cast<double>(kQuietTwins);
      }
    }
    return EstimateDisturbance(dataset_, fit_, by_sensors);
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

  /// The boat `off` the middle, or as near to the middle as it takes not to run away.
  std::optional<Sighting> SightOne(const Eigen::VectorXd& middle, const Eigen::VectorXd& off,
                                   std::uint64_t seed) const {
    for (const double share : {1.0, 0.5, 0.25, 0.0}) {
      Eigen::VectorXd truth = middle + share * off;
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

  void Tell() {
    const std::lock_guard lock(telling_);
    ++done_;
    if (progress_) progress_(static_cast<double>(done_) / static_cast<double>(twins_.twins));
  }

  /// The twins' errors give each whitened direction its size, and tell how much further intervals
  /// and ellipsoids that each twin makes from its own clusters, sized alike, have to reach.
  void Calibrate(const std::vector<Sighting>& sightings, const Spread& spread,
                 TwinCorrection& correction) const {
    const auto n = static_cast<double>(sightings.size());
    const auto p = static_cast<double>(correction.theta.size());
    std::vector<Sighting> sized;
    for (const Sighting& s : sightings) {
      // The mean was fitted to these very twins.
      sized.push_back(
          {std::sqrt(n / (n - 1.0)) * (s.error - spread.mean), Scaled(s.covariance, spread.sd)});
    }
    const Eigen::VectorXd stretch = StretchOf(sized, correction.degrees_of_freedom);
    std::vector<double> joint;
    for (const Sighting& s : sized) {
      const Eigen::VectorXd off = s.error.cwiseQuotient(stretch);
      joint.push_back(off.dot(s.covariance.ldlt().solve(off)) / p);
    }
    // The mean of few twins errs along the very directions in which single twins do.
    const Eigen::MatrixXd scaled =
        std::sqrt(1.0 + 1.0 / n) * (white_.map * spread.sd.cwiseProduct(stretch).asDiagonal());
    correction.covariance = Mapped(scaled, white_.Of(clustered_));
    correction.joint = {LogNormalQuantile(joint, kCalibratedAt) /
                            JointQuantile(correction.degrees_of_freedom, p, kCalibratedAt),
                        correction.degrees_of_freedom};
  }

  /// By what the standard errors of each block have to be stretched for the twins' own intervals to
  /// hold; never below one, as twins know only what they were told of the boat.
  Eigen::VectorXd StretchOf(const std::vector<Sighting>& sized, double degrees_of_freedom) const {
    std::vector<std::vector<double>> pivots(blocks_.size());
    for (const Sighting& s : sized) {
      const Eigen::VectorXd sizes = Mapped(white_.map, s.covariance).diagonal().cwiseSqrt();
      const Eigen::VectorXd pivot = (white_.map * s.error).cwiseQuotient(sizes).cwiseAbs();
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const auto of_block = pivot.segment(blocks_[b].begin, blocks_[b].size);
        pivots[b].insert(pivots[b].end(), of_block.begin(), of_block.end());
      }
    }
    const double promised = StudentQuantile(degrees_of_freedom, 0.5 * (1.0 + kCalibratedAt));
    Eigen::VectorXd stretch(white_.map.rows());
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      stretch.segment(blocks_[b].begin, blocks_[b].size)
          .setConstant(std::max(1.0, Quantile(pivots[b], kCalibratedAt) / promised));
    }
    return stretch;
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
