#include "telltale/core/diagnosis/hypotheses/variation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "telltale/core/base/gauss_markov_series.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/effects/gust_pattern.hpp"

namespace telltale {
namespace {

constexpr double kInvisible = 1e-12;
constexpr VariationConstants kVariation = kDiagnosis.variation;

/// Length of the vector of sizes.
double LengthOf(const ModelledEffect& modelled) {
  double squared = 0.0;
  for (const double size : SizesOf(modelled)) squared += size * size;
  return std::sqrt(squared);
}

/// One standard deviation of what varies: of an intermittent effect its own, of others the
/// turbulence intensity times the length of the mean.
double DeviationOf(const ModelledEffect& modelled, double intermittent_sd) {
  if (modelled.effect->IsIntermittent()) return intermittent_sd;
  return modelled.effect->Facts().turbulence_intensity * LengthOf(modelled);
}

/// Whether it varies from free run to free run as a Gauss-Markov process does.
bool Drifts(const Effect& effect) {
  return effect.Facts().drift_time_s > 0.0;
}

Eigen::MatrixXd SideBySide(const std::vector<Eigen::VectorXd>& columns, Eigen::Index rows) {
  Eigen::MatrixXd matrix(rows, std::ssize(columns));
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    matrix.col(j) = columns[static_cast<std::size_t>(j)];
  }
  return matrix;
}

/// One way in which a gust may run through a window, and its share of the gust's variance.
struct GustCourse {
  double frequency_rad_s = 0.0;  ///< 0: the same all along
  double phase_rad = 0.0;
  double share = 1.0;
};

/// The ways of an effect's gusts, the constant one first. What oscillates faster than by half a
/// turn within a window hardly moves a boat, unless it begins and ends there.
std::vector<GustCourse> CoursesOf(const Effect& effect, double window_s) {
  const EffectFacts& facts = effect.Facts();
  if (facts.turbulence_time_s == 0.0) return {{}};
  const double lasting = facts.turbulence_time_s / window_s;
  const int fastest = effect.IsIntermittent() ? kVariation.half_turns_of_a_spell : 1;
  std::vector<GustCourse> courses = {{0.0, 0.0, GaussMarkovShare(0, lasting)}};
  for (int k = 1; k <= fastest; ++k) {
    const double share = GaussMarkovShare(k, lasting);
    const double frequency = k * std::numbers::pi / window_s;
    courses.push_back({frequency, 0.0, share});
    courses.push_back({frequency, -0.5 * std::numbers::pi, share});
  }
  return courses;
}

/// What a deviation of one parameter of one effect, along a course, does to the errors.
/// Oscillations are no larger than the effect itself, beyond which it may act on the other side,
/// and scaled to the deviation.
Eigen::MatrixXd EffectOfGust(const std::vector<ModelledEffect>& effects,
                             const Eigen::MatrixXd& errors, std::size_t gusting,
                             std::size_t parameter, double deviation, const GustCourse& course,
                             const ErrorModel& error_model) {
  auto changed = effects;
  if (course.frequency_rad_s == 0.0) {
    double& value = changed[gusting].values[parameter];
    value += std::copysign(deviation, value);
    return error_model(changed) - errors;
  }
  const double amplitude = std::min(deviation, LengthOf(effects[gusting]));
  if (amplitude == 0.0) return Eigen::MatrixXd::Zero(errors.rows(), errors.cols());
  const GustPattern pattern(*effects[gusting].effect,
                            {parameter, amplitude, course.frequency_rad_s, course.phase_rad});
  changed[gusting].effect = &pattern;
  return deviation / amplitude * (error_model(changed) - errors);
}

}  // namespace

std::vector<double> SizesOf(const ModelledEffect& modelled) {
  std::vector<double> sizes;
  for (std::size_t j = 0; j < modelled.values.size(); ++j) {
    if (!modelled.effect->Parameters()[j].is_shape) sizes.push_back(modelled.values[j]);
  }
  return sizes;
}

double MiddleScatterOf(const Effect& intermittent) {
  const std::vector<double>& sds = intermittent.Facts().intermittent_sds;
  return sds[sds.size() / 2];
}

ErrorVariation VariationOf(const std::vector<ModelledEffect>& effects, double intermittent_sd,
                           const Eigen::MatrixXd& errors, const ErrorModel& error_model,
                           double window_s) {
  std::vector<Eigen::VectorXd> by_window;
  std::vector<Eigen::VectorXd> drifting;
  ErrorVariation variation;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const Effect& effect = *effects[i].effect;
    const double deviation = DeviationOf(effects[i], intermittent_sd);
    if (deviation == 0.0) continue;
    if (Drifts(effect)) variation.drift_time_s = effect.Facts().drift_time_s;
    std::vector<Eigen::VectorXd>& columns = Drifts(effect) ? drifting : by_window;
    for (std::size_t j = 0; j < effect.Parameters().size(); ++j) {
      if (effect.Parameters()[j].is_shape) continue;
      if (effect.IsIntermittent()) variation.spells.push_back(std::ssize(columns));
      for (const GustCourse& course : CoursesOf(effect, window_s)) {
        const double size = deviation * std::sqrt(course.share);
        columns.emplace_back(
            EffectOfGust(effects, errors, i, j, size, course, error_model).reshaped());
      }
    }
  }
  variation.by_window = SideBySide(by_window, errors.size());
  variation.drifting = SideBySide(drifting, errors.size());
  return variation;
}

double ScatterDeficit(const ErrorVariation& variation, const Eigen::MatrixXd& errors,
                      const ResidualMetric& metric) {
  const Eigen::MatrixXd left = metric.UnexplainedByWindow(metric.Whiten(errors));
  double deficit = 0.0;
  for (const Eigen::Index column : variation.spells) {
    const Eigen::VectorXd spell = metric.WhitenColumns(variation.by_window.col(column)).col(0);
    const Eigen::MatrixXd by_window =
        spell.reshaped(left.rows(), left.cols()) / std::sqrt(metric.Kappa());
    const Eigen::ArrayXd squares = by_window.colwise().squaredNorm().transpose().array();
    const double visible = std::max(squares.sum(), kInvisible);
    const Eigen::ArrayXd sums = left.cwiseProduct(by_window).colwise().sum().transpose().array();
    // What all windows have in common is no scatter.
    const Eigen::ArrayXd along = sums - sums.sum() / visible * squares;
    // Each window's own noise adds one.
    const double realised = (along.square() / squares.max(kInvisible) - 1.0).sum();
    const double ratio = std::clamp(realised / visible, kVariation.least_scatter, 1.0);
    deficit += metric.EffectiveObservations() * (ratio - 1.0 - std::log(ratio));
  }
  return deficit;
}

}  // namespace telltale
