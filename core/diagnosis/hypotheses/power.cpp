#include "telltale/core/diagnosis/hypotheses/power.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_fit.hpp"
#include "telltale/core/diagnosis/hypotheses/effect_parameters.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr double kPower = kDiagnosis.testability.power;
// Nodes of equal probability over the noise of a day.
constexpr int kNoiseNodes = 15;
// The distance that an effect moves errors grows with the square of its size as long as it acts
// linearly, so that few steps do.
constexpr int kSizeSteps = 5;
constexpr double kSizeTolerance = 0.01;
constexpr int kBisections = 40;

/// Tail of a noncentral chi-squared variable of one degree of freedom, the square of a normal one.
double NoncentralTail(double noncentrality, double x) {
  const double mean = std::sqrt(noncentrality);
  return NormalTail(std::sqrt(x) - mean) + NormalTail(std::sqrt(x) + mean);
}

/// The noncentrality at which PowerOf reaches kPower.
double NoncentralityFor(double cost, const ResidualMetric& metric, const NoiseLevels& noise) {
  double low = 0.0;
  double high = metric.ExpectedSquare();
  while (PowerOf(high, cost, metric, noise) < kPower) high *= 2.0;
  for (int i = 0; i < kBisections && high - low > 1e-3 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (PowerOf(middle, cost, metric, noise) < kPower ? low : high) = middle;
  }
  return high;
}

/// How one parameter of an effect moves the errors of the nominal boat.
class ParameterShift {
 public:
  ParameterShift(const Effect& effect, std::size_t parameter, const DiagnosisProblem& problem)
      : effect_(effect),
        parameter_(parameter),
        metric_(problem.metric),
        error_model_(ErrorModelOf(problem.runs, problem.nominal.boat)),
        nominal_(metric_.Whiten(error_model_({}))) {}

  /// By how large a squared Mahalanobis distance the parameter at `value` moves the errors.
  double NoncentralityAt(double value) const {
    ModelledEffect modelled{&effect_, {}};
    for (const EffectParameter& other : effect_.Parameters()) {
      modelled.values.push_back(other.prior_mean);
    }
    modelled.values[parameter_] = value;
    return metric_.SquaredMahalanobis(metric_.Whiten(error_model_({modelled})) - nominal_);
  }

 private:
  const Effect& effect_;
  std::size_t parameter_;
  const ResidualMetric& metric_;
  ErrorModel error_model_;
  Eigen::VectorXd nominal_;
};

/// What decides whether an effect shows, besides what it does to the errors.
struct Gate {
  const ResidualMetric& metric;
  NoiseLevels noise;
  double nominal_gain = 0.0;
  double parameters = 1.0;  ///< that are fitted
};

/// What the score of a parameter of `sizes` typical sizes pays, (89): its prior and the volume that
/// an estimate leaves of it, as of each parameter of the effect; besides the gain on nominal
/// recordings.
double CostOf(double sizes, double noncentrality, const Gate& gate) {
  const double prior_variance =
      kDiagnosis.effect_fit.prior_width * kDiagnosis.effect_fit.prior_width;
  const double left = gate.metric.ExpectedSquare() * std::exp(gate.noise.log_mean);
  const double information =
      gate.metric.EffectiveObservations() / left * noncentrality / (sizes * sizes);
  return gate.nominal_gain + sizes * sizes / prior_variance +
         gate.parameters * std::log1p(prior_variance * information);
}

/// The smallest size between zero and `end`; nothing where not even the end of the range shows.
std::optional<double> DetectableTowards(double end, const ParameterShift& shift,
                                        const EffectParameter& parameter, const Gate& gate) {
  double size = std::min(parameter.typical, std::abs(end));
  for (int step = 0; step < kSizeSteps; ++step) {
    const double noncentrality = shift.NoncentralityAt(std::copysign(size, end));
    if (noncentrality <= 0.0) return std::nullopt;
    const double cost = CostOf(size / parameter.typical, noncentrality, gate);
    const double ratio = std::sqrt(NoncentralityFor(cost, gate.metric, gate.noise) / noncentrality);
    if (std::abs(ratio - 1.0) < kSizeTolerance) return size;
    if (size >= std::abs(end) && ratio > 1.0) return std::nullopt;
    size = std::min(size * ratio, std::abs(end));
  }
  return size < std::abs(end) ? std::optional(size) : std::nullopt;
}

DetectableSize DetectableSizeOf(const Effect& effect, std::size_t place,
                                const DiagnosisProblem& problem, const Gate& gate) {
  const EffectParameter& parameter = effect.Parameters()[place];
  const ParameterShift shift(effect, place, problem);
  DetectableSize detectable{std::string(parameter.name), std::nullopt, std::string(parameter.unit)};
  std::optional<double> largest = 0.0;
  for (const double end : {parameter.lower, parameter.upper}) {
    if (end == 0.0 || !largest) continue;
    const auto size = DetectableTowards(end, shift, parameter, gate);
    largest = size ? std::optional(std::max(*largest, *size)) : std::nullopt;
  }
  detectable.size = largest;
  return detectable;
}

}  // namespace

NoiseLevels NoiseLevelsOf(const NominalBaseline& nominal) {
  const std::vector<double>& logs = nominal.log_reduced_chi_squares;
  const auto days = static_cast<double>(logs.size());
  NoiseLevels noise;
  for (const double log : logs) noise.log_mean += log / days;
  double variance = kDiagnosis.gap.single_recording_sd * kDiagnosis.gap.single_recording_sd;
  if (logs.size() > 1) {
    variance = 0.0;
    for (const double log : logs) {
      variance += (log - noise.log_mean) * (log - noise.log_mean) / (days - 1.0);
    }
  }
  noise.log_sd = std::sqrt(variance * (1.0 + 1.0 / days));
  noise.degrees_of_freedom = std::max(days - 1.0, 1.0);
  return noise;
}

double PowerOf(double noncentrality, double cost, const ResidualMetric& metric,
               const NoiseLevels& noise) {
  const RankingConstants& ranking = kDiagnosis.ranking;
  const double by_score =
      std::expm1((ranking.material_score + cost) / metric.EffectiveObservations());
  double power = 0.0;
  for (int node = 0; node < kNoiseNodes; ++node) {
    const double probability = (node + 0.5) / kNoiseNodes;
    const double log_excess = noise.log_sd * StudentQuantile(noise.degrees_of_freedom, probability);
    const double by_lack_of_fit = std::expm1(ranking.material_log_lack_of_fit - log_excess);
    const double threshold = metric.ExpectedSquare() * std::min(by_score, by_lack_of_fit);
    const double in_its_noise = noncentrality / std::exp(noise.log_mean + log_excess);
    power += threshold <= 0.0 ? 1.0 : NoncentralTail(in_its_noise, threshold);
  }
  return power / kNoiseNodes;
}

std::vector<DetectableSize> DetectableSizesOf(const Effect& effect, const DiagnosisProblem& problem,
                                              double nominal_gain) {
  std::vector<DetectableSize> sizes;
  if (effect.IsStochastic()) return sizes;
  const Gate gate{problem.metric, NoiseLevelsOf(problem.nominal), nominal_gain,
                  static_cast<double>(effect.Parameters().size())};
  for (std::size_t place = 0; place < effect.Parameters().size(); ++place) {
    if (effect.Parameters()[place].is_shape) continue;
    sizes.push_back(DetectableSizeOf(effect, place, problem, gate));
  }
  return sizes;
}

}  // namespace telltale
