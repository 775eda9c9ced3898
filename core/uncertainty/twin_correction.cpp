#include "uncertainty/twin_correction.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include <Eigen/Cholesky>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "contract.hpp"
#include "estimation/disturbance.hpp"
#include "parallel.hpp"
#include "random.hpp"
#include "simulation/dataset_twin.hpp"

namespace telltale {
namespace {

constexpr double kCalibratedAt = 0.95;
constexpr std::size_t kQuietTwins = 2;
// A bias that is jointly larger than the noise hangs on directions that the data hardly determine.
constexpr double kBelievedJointBias = 1.0;
constexpr double kWildPivot =
    4.0;  // standard errors; where instruments are weak one may be any size

/// What one twin gave.
struct Sighting {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
};

/// Whether there is anything to compare: where instruments all but vanish numbers overflow.
bool IsSound(const Sighting& sighting) {
  return sighting.theta.allFinite() && sighting.covariance.allFinite() &&
         (sighting.covariance.diagonal().array() > 0.0).all();
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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

/// Weights of the twins, below one for those that lie wildly apart from the rest in any
/// coefficient: where instruments are weak a single twin can be off by any amount. A twin is
/// weighed as a whole, since coefficients err together: drawn in one by one they would no longer
/// fit each other.
std::vector<double> WeighWild(const std::vector<Sighting>& sightings) {
  constexpr double kWild = 4.0;
  constexpr double kMadToSigma = 1.4826;
  std::vector<double> weights(sightings.size(), 1.0);
  for (Eigen::Index j = 0; j < sightings.front().theta.size(); ++j) {
    std::vector<double> values;
    for (const Sighting& s : sightings) values.push_back(s.theta[j]);
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
  const Eigen::Index p = sightings.front().theta.size();
  Spread spread{Eigen::VectorXd::Zero(p), Eigen::VectorXd::Zero(p)};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    spread.mean += weights[i] / n * sightings[i].theta;
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    spread.sd += weights[i] / (n - 1.0) * (sightings[i].theta - spread.mean).cwiseAbs2();
  }
  spread.sd = spread.sd.cwiseSqrt();
  return spread;
}

/// The quantile of few positive values, by way of the middle and the spread of their logarithms.
double LogNormalQuantile(std::vector<double> values, double share) {
  constexpr double kMadToSigma = 1.4826;
  for (double& value : values) value = std::log(value);
  const double middle = Median(values);
  const double sigma = kMadToSigma * MedianSize(values, middle);
  return std::exp(middle + sigma * boost::math::quantile(boost::math::normal(), share));
}

class TwinRounds {
 public:
  TwinRounds(const PreparedDataset& dataset, const RegressionOptions& regression,
             const WeakFit& fit, const std::array<std::vector<std::size_t>, 3>& columns,
             const WeakIvOptions& options, const TwinCorrectionOptions& twins,
             const std::function<void(double)>& progress)
      : dataset_(dataset),
        regression_(regression),
        fit_(fit),
        columns_(columns),
        options_(options),
        twins_(twins),
        progress_(progress) {}

  std::optional<Disturbance> DisturbanceAlone() const {
    const auto found = FindSailable();
    if (!found) return std::nullopt;
    return JudgeDisturbance(*found);
  }

  std::optional<TwinCorrection> Run() {
    const auto found = FindSailable();
    if (!found) return std::nullopt;
    const Eigen::VectorXd& start = found->theta;
    TwinCorrection correction;
    correction.disturbance = JudgeDisturbance(*found);
    disturbance_ = correction.disturbance;
    disturbance_.time_constant_s *= twins_.time_scale;
    const auto sightings = Sight(start);
    if (2 * sightings.size() < twins_.twins) return std::nullopt;
    const Spread spread = SpreadOf(sightings);
    const Eigen::VectorXd bias = spread.mean - start;
    correction.joint_bias = JointSize(bias);
    correction.corrected = correction.joint_bias <= kBelievedJointBias;
    correction.theta = correction.corrected ? fit_.theta - bias : fit_.theta;
    correction.solved = sightings.size();
    correction.failures = twins_.twins - sightings.size();
    correction.degrees_of_freedom = static_cast<double>(fit_.scores.cols()) - 1.0;
    Calibrate(sightings, spread, correction);
    if (!correction.corrected) {
      correction.covariance += bias * bias.transpose();
      correction.joint_covariance += bias * bias.transpose();
    }
    return correction;
  }

 private:
  /// Unknowns that can be sailed, and what they give in still water.
  struct Sailable {
    Eigen::VectorXd theta;
    std::vector<PreparedDataset> quiet;
  };

  /// The estimate, or as much of it as needed moved towards the damped one until it does not run
  /// away: where the data say little its numbers may be wild.
  std::optional<Sailable> FindSailable() const {
    const Eigen::VectorXd damped = fit_.Damped();
    for (const double share : {1.0, 0.5, 0.25, 0.0}) {
      Sailable found{damped + share * (fit_.theta - damped), {}};
      const VesselModel model = ModelOf(fit_, found.theta, dataset_.sampling_period_s);
      for (std::size_t i = 0; i < kQuietTwins; ++i) {
        auto quiet = SailAgain(dataset_, model,
                               {{},
                                twins_.noise_scale,
                                SeedOf(twins_.twins + i),
                                Unanswered(),
                                SteadyOf(fit_, found.theta)});
        if (quiet) found.quiet.push_back(*std::move(quiet));
      }
      if (found.quiet.size() == kQuietTwins) return found;
    }
    return std::nullopt;
  }

  /// What the residuals show beyond what sensors alone leave in still water.
  Disturbance JudgeDisturbance(const Sailable& sailable) const {
    std::array<Eigen::VectorXd, 3> by_sensors;
    by_sensors.fill(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kDisturbanceLags)));
    for (const PreparedDataset& quiet : sailable.quiet) {
      const WeakProblem problem = BuildWeakForm(quiet, regression_, options_.form);
      const auto residuals = ResidualsOf(fit_, sailable.theta, quiet, problem);
      for (std::size_t j = 0; j < 3; ++j) {
        if (residuals[j].size() == 0) continue;
        by_sensors[j] += Autocovariance(problem.phi, problem.windows[j], residuals[j]) /
                         static_cast<double>(kQuietTwins);
      }
    }
    return EstimateDisturbance(dataset_, fit_, by_sensors);
  }

  /// Of a vector of unknowns, against the covariance of the fit: near one for what noise alone
  /// does.
  double JointSize(const Eigen::VectorXd& off) const {
    return off.dot(ClusterCovariance(fit_).ldlt().solve(off)) / static_cast<double>(off.size());
  }

  std::array<bool, 3> Unanswered() const {
    return {!fit_.equations[0], !fit_.equations[1], !fit_.equations[2]};
  }

  std::uint64_t SeedOf(std::size_t twin) const { return RandomEngine::Stream(twins_.seed, twin)(); }

  std::vector<Sighting> Sight(const Eigen::VectorXd& theta) {
    const VesselModel model = ModelOf(fit_, theta, dataset_.sampling_period_s);
    const std::vector<SteadyDisturbance> steady = SteadyOf(fit_, theta);
    std::vector<std::optional<Sighting>> all(twins_.twins);
    ForEachIndex(all.size(), twins_.threads, [&](std::size_t i) {
      const auto twin = SailAgain(
          dataset_, model, {disturbance_, twins_.noise_scale, SeedOf(i), Unanswered(), steady});
      if (twin) {
        const auto again = EstimateWeakIv(*twin, regression_, columns_, options_);
        if (again) all[i] = Sighting{again->theta, ClusterCovariance(*again)};
        if (all[i] && !IsSound(*all[i])) all[i].reset();
      }
      Tell();
    });
    std::vector<Sighting> seen;
    for (auto& sighting : all) {
      if (sighting) seen.push_back(*std::move(sighting));
    }
    return seen;
  }

  void Tell() {
    const std::lock_guard lock(telling_);
    ++done_;
    if (progress_) progress_(static_cast<double>(done_) / static_cast<double>(twins_.twins));
  }

  void Calibrate(const std::vector<Sighting>& sightings, const Spread& spread,
                 TwinCorrection& correction) const {
    const auto n = static_cast<double>(sightings.size());
    const auto p = static_cast<double>(correction.theta.size());
    // The mean was fitted to these very twins.
    const double widened = std::sqrt(n / (n - 1.0));
    std::vector<double> pivots;
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(correction.theta.size());
    std::vector<double> joint;
    for (const Sighting& s : sightings) {
      const Eigen::VectorXd off = widened * (s.theta - spread.mean);
      const Eigen::VectorXd pivot = off.cwiseQuotient(s.covariance.diagonal().cwiseSqrt());
      for (const double value : pivot) pivots.push_back(std::abs(value));
      squares += pivot.cwiseAbs().cwiseMin(kWildPivot).cwiseAbs2() / n;
      joint.push_back(off.dot(s.covariance.ldlt().solve(off)) / p);
    }
    const boost::math::students_t student(correction.degrees_of_freedom);
    // Never below one: twins know only what they were told of the boat.
    correction.calibration =
        std::max(1.0, Quantile(pivots, kCalibratedAt) /
                          boost::math::quantile(student, 0.5 * (1.0 + kCalibratedAt)));
    // A few dozen twins know one coefficient's own factor to a tenth, so it is believed half.
    const Eigen::VectorXd own = (squares / squares.mean()).array().pow(0.25);
    const Eigen::VectorXd factor = correction.calibration * own;
    const Eigen::MatrixXd covariance = ClusterCovariance(fit_);
    correction.covariance = factor.asDiagonal() * covariance * factor.asDiagonal();
    correction.covariance.diagonal() += spread.sd.cwiseAbs2() / n;
    // The mean of few twins errs along the very directions in which single twins do.
    correction.joint_covariance = (1.0 + 1.0 / n) * LogNormalQuantile(joint, kCalibratedAt) /
                                  JointQuantile(correction.degrees_of_freedom, p, kCalibratedAt) *
                                  covariance;
  }

  const PreparedDataset& dataset_;
  const RegressionOptions& regression_;
  const WeakFit& fit_;
  const std::array<std::vector<std::size_t>, 3>& columns_;
  const WeakIvOptions& options_;
  const TwinCorrectionOptions& twins_;
  const std::function<void(double)>& progress_;
  Disturbance disturbance_;
  std::mutex telling_;
  std::size_t done_ = 0;
};

}  // namespace

double JointQuantile(double degrees_of_freedom, double unknowns, double level) {
  // Hotelling's law needs more clusters than unknowns; covariances drawn towards a full shape do
  // not.
  constexpr double kFewestSpare = 5.0;
  const double spare = std::max(degrees_of_freedom - unknowns + 1.0, kFewestSpare);
  return boost::math::quantile(boost::math::fisher_f(unknowns, spare), level);
}

std::optional<TwinCorrection> CorrectWithTwins(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const TwinCorrectionOptions& twins, const std::function<void(double fraction)>& progress) {
  Require(twins.twins >= 8, "at least eight twins");
  return TwinRounds(dataset, regression, fit, columns, options, twins, progress).Run();
}

std::optional<Disturbance> JudgeDisturbance(const PreparedDataset& dataset,
                                            const RegressionOptions& regression, const WeakFit& fit,
                                            const std::array<std::vector<std::size_t>, 3>& columns,
                                            const WeakIvOptions& options, std::uint64_t seed) {
  TwinCorrectionOptions twins;
  twins.seed = seed;
  return TwinRounds(dataset, regression, fit, columns, options, twins, {}).DisturbanceAlone();
}

}  // namespace telltale
