#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "support/stable_boat_with_effects.hpp"
#include "telltale/core/diagnosis/baseline/residual_metric.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale::testing {

/// An effect with parameters and no action of its own, whose sensitivities a test chooses.
class InertEffect final : public Effect {
 public:
  InertEffect(std::string_view name, std::vector<EffectParameter> parameters,
              double turbulence_intensity = 0.0, std::vector<double> intermittent_sds = {},
              bool is_weather = false)
      : Effect({.name = name,
                .title = name,
                .equation = "",
                .source = "",
                .parameters = std::move(parameters),
                .settled_by = "a sensor",
                .hook = Hook::kNone,
                .nominal_variation = NominalVariation::kFixedEffect,
                .turbulence_intensity = turbulence_intensity,
                .intermittent_sds = std::move(intermittent_sds),
                .is_weather = is_weather}) {}
  std::string Describe(EffectValues) const override { return std::string(Name()); }
};

/// A baseline of independent unit errors whose boat is known exactly: whitening and marginalising
/// leave errors as they are.
inline NominalBaseline UnitBaseline(Eigen::Index rows, Eigen::Index coefficients,
                                    Eigen::Index parameters) {
  NominalBaseline nominal;
  nominal.boat = {StableBoat(), {}};
  nominal.coefficients = Eigen::VectorXd::Zero(coefficients);
  nominal.covariance = Eigen::MatrixXd::Identity(rows, rows);
  nominal.boat_covariance =
      Eigen::MatrixXd::Zero(coefficients + parameters, coefficients + parameters);
  nominal.recording_effect_sd = Eigen::VectorXd::Zero(parameters);
  return nominal;
}

/// Numbers between -1 and 1 that repeat nowhere.
inline Eigen::MatrixXd Pattern(Eigen::Index rows, Eigen::Index columns, double frequency) {
  Eigen::MatrixXd pattern(rows, columns);
  for (Eigen::Index i = 0; i < pattern.size(); ++i) {
    pattern.reshaped()[i] = std::sin(frequency * (static_cast<double>(i) + 1.0));
  }
  return pattern;
}

inline Sensitivity SensitivityOfErrors(const Eigen::MatrixXd& errors, Eigen::Index coefficients,
                                       Eigen::Index parameters) {
  return {errors, Eigen::MatrixXd::Zero(errors.size(), coefficients),
          Eigen::MatrixXd::Zero(errors.size(), parameters)};
}

/// Free runs of a short recording of the stable boat, for the times and number of its windows.
struct ShortRecording {
  explicit ShortRecording(double duration_s = 120.0,
                          const std::vector<ModelledEffect>& effects = {})
      : dataset(SimulateWithEffects(effects, duration_s, 500)) {}

  PreparedDataset dataset;
  UncertainModel model = UncertainModelOf(KnownStableBoat()).value();
  FreeRuns runs{dataset, model.model, 5.0};
};

/// The free runs of one recording alone, as the references of a baseline.
inline std::vector<FreeRuns> RunsOf(const PreparedDataset& dataset, const VesselModel& model) {
  std::vector<FreeRuns> runs;
  runs.emplace_back(dataset, model, 5.0);
  return runs;
}

/// The same and the nominal boat that is learned from it.
struct LearnedBaseline : ShortRecording {
  std::vector<EffectParameterRef> parameter_refs = EffectParameterRefsOf(EffectLibrary());
  NominalBaseline nominal =
      LearnNominalBaseline(RunsOf(dataset, model.model), model, parameter_refs, 2);
  Sensitivity recording =
      SensitivityOf(runs, {nominal.boat, nominal.coefficients}, model, parameter_refs, 2);
};

}  // namespace telltale::testing
