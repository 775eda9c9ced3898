#include "telltale/core/diagnosis/baseline/mixed_effects_fit.hpp"

#include <cmath>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/linear_algebra/gram.hpp"
#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"

namespace telltale {
namespace {

constexpr double kPriorEffectSize = kDiagnosis.baseline.prior_effect_size;
constexpr double kPriorRecordings = kDiagnosis.baseline.prior_recordings;
constexpr double kCoefficientPriorScale = kDiagnosis.baseline.coefficient_prior_scale;
constexpr int kIterations = kDiagnosis.baseline.variance_iterations;

/// The bounds of these effect parameters in typical sizes, one row each.
Eigen::MatrixXd LimitsOf(const std::vector<Eigen::Index>& columns,
                         const std::vector<EffectParameterRef>& parameter_refs) {
  Eigen::MatrixXd limits(std::ssize(columns), 2);
  for (Eigen::Index j = 0; j < limits.rows(); ++j) {
    const EffectParameterRef& parameter_ref =
        parameter_refs[static_cast<std::size_t>(columns[static_cast<std::size_t>(j)])];
    const EffectParameter& parameter = parameter_ref.effect->Parameters()[parameter_ref.parameter];
    limits.row(j) << parameter.lower / parameter.typical, parameter.upper / parameter.typical;
  }
  return limits;
}

}  // namespace

NominalVariations NominalVariationsOf(const std::vector<EffectParameterRef>& parameter_refs) {
  NominalVariations variations;
  for (Eigen::Index j = 0; j < std::ssize(parameter_refs); ++j) {
    switch (parameter_refs[static_cast<std::size_t>(j)].effect->Facts().nominal_variation) {
      case NominalVariation::kFixedEffect: variations.fixed.push_back(j); break;
      case NominalVariation::kRecordingEffect: variations.weather.push_back(j); break;
      case NominalVariation::kInCoefficients:
      case NominalVariation::kNone: break;
    }
  }
  return variations;
}

MixedEffectsFit::MixedEffectsFit(const UncertainModel& model,
                                 const std::vector<EffectParameterRef>& parameter_refs,
                                 std::size_t days)
    : variations_(NominalVariationsOf(parameter_refs)),
      parameter_count_(std::ssize(parameter_refs)),
      days_(static_cast<Eigen::Index>(days)),
      coefficients_(Eigen::VectorXd::Zero(std::ssize(model.free))),
      fixed_(Eigen::VectorXd::Zero(std::ssize(variations_.fixed))),
      fixed_limits_(LimitsOf(variations_.fixed, parameter_refs)),
      fixed_sd_(
          Eigen::VectorXd::Constant(fixed_.size(), kDiagnosis.baseline.initial_fixed_effect_sd)),
      weather_sd_(Eigen::VectorXd::Constant(WeatherCount(), kPriorEffectSize)) {
  Eigen::MatrixXd correlation = model.Correlation();
  correlation.diagonal().array() += 1e-6;
  prior_information_ = Inverse(correlation) / (kCoefficientPriorScale * kCoefficientPriorScale);
}

void MixedEffectsFit::StartFrom(const Eigen::VectorXd& coefficients,
                                const Eigen::VectorXd& fixed_effects) {
  coefficients_ = coefficients;
  fixed_ = fixed_effects(variations_.fixed);
}

void MixedEffectsFit::Accumulate(const std::vector<Sensitivity>& recordings,
                                 const Eigen::LLT<Eigen::MatrixXd>& factor, double kappa) {
  const Eigen::Index shared = Shared();
  const Eigen::Index size = shared + days_ * WeatherCount();
  gram_ = Eigen::MatrixXd::Zero(size, size);
  right_ = Eigen::VectorXd::Zero(size);
  for (std::size_t day = 0; day < recordings.size(); ++day) {
    const Sensitivity& recording = recordings[day];
    Eigen::MatrixXd phi(recording.errors.size(), shared + WeatherCount() + 1);
    phi << recording.by_coefficient, recording.by_effect_parameter(Eigen::all, variations_.fixed),
        recording.by_effect_parameter(Eigen::all, variations_.weather), recording.errors.reshaped();
    const Eigen::MatrixXd white = Whitened(factor, phi);
    const Eigen::MatrixXd gram = kappa * Gram(white);
    const Eigen::Index own = OwnOf(day);
    const auto last = gram.col(shared + WeatherCount());
    gram_.topLeftCorner(shared, shared) += gram.topLeftCorner(shared, shared);
    gram_.block(0, own, shared, WeatherCount()) = gram.block(0, shared, shared, WeatherCount());
    gram_.block(own, 0, WeatherCount(), shared) = gram.block(shared, 0, WeatherCount(), shared);
    gram_.block(own, own, WeatherCount(), WeatherCount()) =
        gram.block(shared, shared, WeatherCount(), WeatherCount());
    right_.head(shared) -= last.head(shared);
    right_.segment(own, WeatherCount()) = -last.segment(shared, WeatherCount());
  }
}

void MixedEffectsFit::Solve() {
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    unknowns_ = Step();
    UpdateStandardDeviations();
  }
}

void MixedEffectsFit::Accept(double share) {
  coefficients_ += share * unknowns_.head(coefficients_.size());
  fixed_ = (fixed_ + share * unknowns_.segment(coefficients_.size(), fixed_.size()))
               .cwiseMax(fixed_limits_.col(0))
               .cwiseMin(fixed_limits_.col(1));
}

Eigen::MatrixXd MixedEffectsFit::PredictedResiduals(const Sensitivity& recording,
                                                    std::size_t day) const {
  const Eigen::VectorXd by_boat = recording.by_coefficient * unknowns_.head(coefficients_.size()) +
                                  recording.by_effect_parameter(Eigen::all, variations_.fixed) *
                                      unknowns_.segment(coefficients_.size(), fixed_.size());
  return recording.errors + by_boat.reshaped(recording.errors.rows(), recording.errors.cols()) +
         ErrorsBy(unknowns_.segment(OwnOf(day), WeatherCount()), recording);
}

Eigen::MatrixXd MixedEffectsFit::LessWeather(const Eigen::MatrixXd& errors,
                                             const Sensitivity& recording,
                                             const Eigen::LLT<Eigen::MatrixXd>& factor,
                                             double kappa) const {
  if (WeatherCount() == 0) return errors;
  const Eigen::MatrixXd white =
      Whitened(factor, recording.by_effect_parameter(Eigen::all, variations_.weather));
  const Eigen::VectorXd right = -kappa * (white.transpose() * Whitened(factor, errors.reshaped()));
  Eigen::MatrixXd information = kappa * Gram(white);
  information.diagonal() += weather_sd_.cwiseAbs2().cwiseInverse();
  return errors + ErrorsBy(information.llt().solve(right), recording);
}

Eigen::VectorXd MixedEffectsFit::FixedEffects() const {
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(parameter_count_);
  sizes(variations_.fixed) = fixed_;
  return sizes;
}

Eigen::VectorXd MixedEffectsFit::WeatherSd() const {
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(parameter_count_);
  sizes(variations_.weather) = weather_sd_;
  return sizes;
}

Eigen::MatrixXd MixedEffectsFit::BoatCovariance() const {
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = 0; i < coefficients_.size(); ++i) places.push_back(i);
  for (const Eigen::Index j : variations_.fixed) places.push_back(coefficients_.size() + j);
  const Eigen::Index size = coefficients_.size() + parameter_count_;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  covariance(places, places) = Inverse(Information()).topLeftCorner(Shared(), Shared());
  return covariance;
}

/// What weather in the model adds to the errors of a recording.
Eigen::MatrixXd MixedEffectsFit::ErrorsBy(const Eigen::VectorXd& weather,
                                          const Sensitivity& recording) const {
  return (recording.by_effect_parameter(Eigen::all, variations_.weather) * weather)
      .reshaped(recording.errors.rows(), recording.errors.cols());
}

Eigen::MatrixXd MixedEffectsFit::Information() const {
  Eigen::MatrixXd information = gram_;
  information.topLeftCorner(coefficients_.size(), coefficients_.size()) += prior_information_;
  information.diagonal().segment(coefficients_.size(), fixed_.size()) +=
      fixed_sd_.cwiseAbs2().cwiseInverse();
  information.diagonal().tail(days_ * WeatherCount()) +=
      weather_sd_.cwiseAbs2().cwiseInverse().replicate(days_, 1);
  return information;
}

Eigen::VectorXd MixedEffectsFit::Step() const {
  Eigen::VectorXd right = right_;
  right.head(coefficients_.size()) -= prior_information_ * coefficients_;
  right.segment(coefficients_.size(), fixed_.size()) -= fixed_.cwiseQuotient(fixed_sd_.cwiseAbs2());
  return Information().llt().solve(right);
}

// By the most probable unknowns, not by expectation: what weather shares with the coefficients,
// which are the same every day, would otherwise keep it large for ever.
void MixedEffectsFit::UpdateStandardDeviations() {
  const double prior = kPriorRecordings * kPriorEffectSize * kPriorEffectSize;
  const auto weather = unknowns_.tail(days_ * WeatherCount()).reshaped(WeatherCount(), days_);
  weather_sd_ = ((weather.rowwise().squaredNorm().array() + prior) /
                 (static_cast<double>(days_) + kPriorRecordings))
                    .sqrt();
  const Eigen::ArrayXd now = fixed_ + unknowns_.segment(coefficients_.size(), fixed_.size());
  fixed_sd_ = ((prior + now.square()) / (1.0 + kPriorRecordings)).sqrt();
}

}  // namespace telltale
