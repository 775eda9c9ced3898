#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "telltale/core/diagnosis/residuals/sensitivity.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// The effects that a nominal boat may have, at which columns of the sensitivities.
struct NominalVariations {
  std::vector<Eigen::Index> fixed;    ///< the same on every recording
  std::vector<Eigen::Index> weather;  ///< anew on each
};

NominalVariations NominalVariationsOf(const std::vector<EffectParameterRef>& parameter_refs);

/// The mixed-effects model of nominal recordings, docs/concepts/diagnosis.md (84), (85), fitted to
/// their errors about a boat. Unknowns, stacked: coefficients, fixed effects, then the weather of
/// each day. The first two are changes of the boat about which the sensitivities are; weather is
/// estimated anew at each step. Coefficients in standard errors of the model, effects in typical
/// sizes. Vectors of effects have one entry per effect parameter, zero where it does not vary.
class MixedEffectsFit {
 public:
  MixedEffectsFit(const UncertainModel& model,
                  const std::vector<EffectParameterRef>& parameter_refs, std::size_t days);

  /// Changes of the boat that are made already.
  void StartFrom(const Eigen::VectorXd& coefficients, const Eigen::VectorXd& fixed_effects);

  /// Sums up what recordings say, whitened by `factor`, of which a share `kappa` of the windows is
  /// independent.
  void Accumulate(const std::vector<Sensitivity>& recordings,
                  const Eigen::LLT<Eigen::MatrixXd>& factor, double kappa);

  /// In turn unknowns given their standard deviations and these given the unknowns.
  void Solve();

  /// Makes a share of the change that was found; the next one is sought from there.
  void Accept(double share);

  /// The errors of a day after the whole change, if they were linear.
  Eigen::MatrixXd PredictedResiduals(const Sensitivity& recording, std::size_t day) const;

  /// What the most probable weather of a recording leaves of these errors of a boat.
  Eigen::MatrixXd LessWeather(const Eigen::MatrixXd& errors, const Sensitivity& recording,
                              const Eigen::LLT<Eigen::MatrixXd>& factor, double kappa) const;

  const Eigen::VectorXd& Coefficients() const { return coefficients_; }
  Eigen::VectorXd FixedEffects() const;
  Eigen::VectorXd WeatherSd() const;
  /// Of coefficients and fixed effects, by the references.
  Eigen::MatrixXd BoatCovariance() const;

 private:
  Eigen::Index WeatherCount() const { return std::ssize(variations_.weather); }
  Eigen::Index Shared() const { return coefficients_.size() + fixed_.size(); }
  Eigen::Index OwnOf(std::size_t day) const {
    return Shared() + static_cast<Eigen::Index>(day) * WeatherCount();
  }
  Eigen::MatrixXd ErrorsBy(const Eigen::VectorXd& weather, const Sensitivity& recording) const;
  Eigen::MatrixXd Information() const;
  Eigen::VectorXd Step() const;
  void UpdateStandardDeviations();

  NominalVariations variations_;
  Eigen::Index parameter_count_;
  Eigen::Index days_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd fixed_;
  Eigen::MatrixXd fixed_limits_;  // lower and upper
  Eigen::VectorXd fixed_sd_;
  Eigen::VectorXd weather_sd_;
  Eigen::MatrixXd prior_information_;  // of the coefficients
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  Eigen::VectorXd unknowns_;
};

}  // namespace telltale
