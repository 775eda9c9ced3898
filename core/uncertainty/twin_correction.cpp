#include "uncertainty/twin_correction.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include <Eigen/Cholesky>
#include <boost/math/distributions/fisher_f.hpp>
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

/// What one twin gave.
struct Sighting {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
};

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

/// Mean and standard deviation by coefficient, wild values drawn in: where instruments are weak a
/// single twin can be off by any amount.
struct Spread {
  Eigen::VectorXd mean;
  Eigen::VectorXd sd;
};

Spread RobustSpread(const std::vector<Sighting>& sightings) {
  constexpr double kWild = 4.0;
  constexpr double kMadToSigma = 1.4826;
  const auto n = static_cast<double>(sightings.size());
  Spread spread{Eigen::VectorXd::Zero(sightings.front().theta.size()), {}};
  spread.sd = spread.mean;
  for (Eigen::Index j = 0; j < spread.mean.size(); ++j) {
    std::vector<double> values;
    for (const Sighting& s : sightings) values.push_back(s.theta[j]);
    const double middle = Median(values);
    std::vector<double> sizes;
    for (const double value : values) sizes.push_back(std::abs(value - middle));
    const double reach = kWild * kMadToSigma * Median(sizes);
    double sum = 0.0;
    double squares = 0.0;
    for (double& value : values) {
      value = std::clamp(value, middle - reach, middle + reach);
      sum += value;
    }
    for (const double value : values) squares += (value - sum / n) * (value - sum / n);
    spread.mean[j] = sum / n;
    spread.sd[j] = std::sqrt(squares / (n - 1.0));
  }
  return spread;
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

  std::optional<TwinCorrection> Run() {
    TwinCorrection correction;
    correction.disturbance = JudgeDisturbance();
    disturbance_ = correction.disturbance;
    disturbance_.time_constant_s *= twins_.time_scale;
    const Eigen::VectorXd start = fit_.Damped();
    const std::size_t half = twins_.twins / 2;
    const auto first = Sight(start, 0, half);
    if (2 * first.size() < half) return std::nullopt;
    const Eigen::VectorXd corrected = start - (RobustSpread(first).mean - start);
    const auto second = Sight(corrected, half, twins_.twins);
    if (2 * second.size() < twins_.twins - half) return std::nullopt;
    const Spread spread = RobustSpread(second);
    correction.theta = fit_.theta - (spread.mean - corrected);
    correction.solved = second.size();
    correction.failures = twins_.twins - first.size() - second.size();
    correction.degrees_of_freedom = static_cast<double>(fit_.scores.cols()) - 1.0;
    Calibrate(second, spread, correction);
    return correction;
  }

 private:
  /// What sensors alone leave in the residuals, from twins in still water; then the rest.
  Disturbance JudgeDisturbance() const {
    const Eigen::VectorXd damped = fit_.Damped();
    const VesselModel model = ModelOf(fit_, damped, dataset_.sampling_period_s);
    std::array<Eigen::VectorXd, 3> by_sensors;
    by_sensors.fill(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kDisturbanceLags)));
    for (std::size_t i = 0; i < kQuietTwins; ++i) {
      const auto quiet =
          SailAgain(dataset_, model, {{}, twins_.noise_scale, SeedOf(twins_.twins + i)});
      if (!quiet) continue;
      const WeakProblem problem = BuildWeakForm(*quiet, regression_, options_.form);
      const auto residuals = ResidualsOf(fit_, damped, *quiet, problem);
      for (std::size_t j = 0; j < 3; ++j) {
        if (residuals[j].size() == 0) continue;
        by_sensors[j] += Autocovariance(problem.phi, problem.windows[j], residuals[j]) /
                         static_cast<double>(kQuietTwins);
      }
    }
    return EstimateDisturbance(dataset_, fit_, by_sensors);
  }

  std::uint64_t SeedOf(std::size_t twin) const { return RandomEngine::Stream(twins_.seed, twin)(); }

  std::vector<Sighting> Sight(const Eigen::VectorXd& theta, std::size_t begin, std::size_t end) {
    const VesselModel model = ModelOf(fit_, theta, dataset_.sampling_period_s);
    std::vector<std::optional<Sighting>> all(end - begin);
    ForEachIndex(all.size(), twins_.threads, [&](std::size_t i) {
      const auto twin = SailAgain(dataset_, model,
                                  {disturbance_, twins_.noise_scale, SeedOf(begin + i)});
      if (twin) {
        const auto again = EstimateWeakIv(*twin, regression_, columns_, options_);
        if (again) all[i] = Sighting{again->theta, ClusterCovariance(*again)};
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
    std::vector<double> joint;
    for (const Sighting& s : sightings) {
      const Eigen::VectorXd off = widened * (s.theta - spread.mean);
      for (Eigen::Index j = 0; j < off.size(); ++j) {
        pivots.push_back(std::abs(off[j]) / std::sqrt(s.covariance(j, j)));
      }
      joint.push_back(off.dot(s.covariance.ldlt().solve(off)) / p);
    }
    const boost::math::students_t student(correction.degrees_of_freedom);
    correction.calibration = Quantile(pivots, kCalibratedAt) /
                             boost::math::quantile(student, 0.5 * (1.0 + kCalibratedAt));
    const double spare = std::max(correction.degrees_of_freedom - p + 1.0, 5.0);
    const boost::math::fisher_f fisher(p, spare);
    const Eigen::MatrixXd covariance = ClusterCovariance(fit_);
    correction.covariance = correction.calibration * correction.calibration * covariance;
    correction.covariance.diagonal() += spread.sd.cwiseAbs2() / n;
    // The mean of few twins errs along the very directions in which single twins do.
    correction.joint_covariance =
        (1.0 + 1.0 / n) * Median(joint) / boost::math::median(fisher) * covariance;
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

std::optional<TwinCorrection> CorrectWithTwins(
    const PreparedDataset& dataset, const RegressionOptions& regression, const WeakFit& fit,
    const std::array<std::vector<std::size_t>, 3>& columns, const WeakIvOptions& options,
    const TwinCorrectionOptions& twins, const std::function<void(double fraction)>& progress) {
  Require(twins.twins >= 8, "at least eight twins");
  return TwinRounds(dataset, regression, fit, columns, options, twins, progress).Run();
}

}  // namespace telltale
