#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"

#include <array>
#include <cmath>
#include <string>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {
namespace {

ResidualMetric::Recalibration RecalibrationOf(const EffectFit& fit,
                                              const DiagnosisProblem& problem) {
  const ResidualMetric metric = fit.WidenedMetric(problem.metric);
  return metric.Recalibrate(metric.Whiten(fit.errors));
}

/// Gives every coefficient its value in `by`, and the free ones of `model` their `covariance`.
void ReplaceCoefficients(const VesselModel& by, const UncertainModel& model,
                         const Eigen::MatrixXd& covariance, Identification& identification) {
  std::array<Eigen::Index, 3> column{};
  std::vector<Eigen::Index> place_of_free;
  for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
    Coefficient& coefficient = identification.coefficients[i];
    const std::size_t equation = IndexOf(coefficient.equation);
    const Eigen::Index own = column[equation]++;
    coefficient.estimate = by.theta[equation][own];
    const std::size_t free = place_of_free.size();
    const bool is_free = free < model.free.size() &&
                         IndexOf(model.free[free].equation) == equation &&
                         model.free[free].column == own;
    if (!is_free) continue;
    const auto place = static_cast<Eigen::Index>(free);
    coefficient.standard_error = std::sqrt(covariance(place, place));
    coefficient.interval = NormalInterval(coefficient.estimate, coefficient.standard_error,
                                          coefficient.interval.level);
    place_of_free.push_back(static_cast<Eigen::Index>(i));
  }
  identification.covariance(place_of_free, place_of_free) = covariance;
}

}  // namespace

AugmentedModel Reidentified(const EffectFit& fit, const DiagnosisProblem& problem,
                            const UncertainModel& model) {
  const Eigen::VectorXd change =
      RecalibrationOf(fit, problem).change.cwiseProduct(model.StandardErrors());
  const AugmentedModel& nominal = problem.nominal.boat;
  return AugmentedModel{model.Changed(nominal.model, change), nominal.effects}.With(fit.effects);
}

Identification Augmented(const Identification& old, const AugmentedModel& boat,
                         const EffectFit& fit, const DiagnosisProblem& problem,
                         const UncertainModel& model) {
  Identification augmented = old;
  ReplaceCoefficients(boat.model, model,
                      Scaled(RecalibrationOf(fit, problem).covariance, model.StandardErrors()),
                      augmented);
  augmented.simulation.clear();
  augmented.effects.clear();
  for (const auto& [effect, values] : boat.effects) {
    augmented.effects.push_back({std::string(effect->Name()), values});
  }
  augmented.provenance.bounds_basis =
      "windows of free runs with the likely effects in the model, from the bounds of the model "
      "that was diagnosed";
  return augmented;
}

Result<AugmentedModel> AugmentedModelOf(const Identification& identification) {
  auto model = ModelOf(identification);
  if (!model) return tl::unexpected<Refusal>(model.error());
  AugmentedModel augmented{*std::move(model), {}};
  for (const AddedEffect& added : identification.effects) {
    const Effect* effect = FindEffect(added.effect);
    if (effect == nullptr || effect->Parameters().size() != added.values.size()) {
      return Refuse("effects", "the model names an effect that the library lacks: " + added.effect,
                    "use a model of the same version");
    }
    augmented.effects.push_back({effect, added.values});
  }
  return augmented;
}

}  // namespace telltale
