#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"

#include <array>
#include <cmath>
#include <string>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/identification/implied_covariance.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {
namespace {

ResidualMetric::Recalibration RecalibrationOf(const EffectFit& fit,
                                              const DiagnosisProblem& problem) {
  const ResidualMetric metric = fit.WidenedMetric(problem.metric);
  return metric.Recalibrate(metric.Whiten(fit.errors));
}

/// By how much the free parameters of the boat recalibrated so differ from the model's.
Eigen::VectorXd ChangeBy(const ResidualMetric::Recalibration& recalibration,
                         const NominalBaseline& nominal, const UncertainModel& model) {
  return (nominal.coefficients + recalibration.change).cwiseProduct(model.StandardErrors());
}

void SetValue(double estimate, double variance, Coefficient& coefficient) {
  coefficient.estimate = estimate;
  coefficient.standard_error = std::sqrt(variance);
  coefficient.interval =
      NormalInterval(estimate, coefficient.standard_error, coefficient.interval.level);
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
    SetValue(coefficient.estimate, covariance(place, place), coefficient);
    place_of_free.push_back(static_cast<Eigen::Index>(i));
  }
  identification.covariance(place_of_free, place_of_free) = covariance;
}

/// Gives the physical parameters their value in `by`, the free ones of `model` their `covariance`,
/// and the coefficients what they imply.
void ReplacePhysicalParameters(const FossenVector& by, const UncertainModel& model,
                               const Eigen::MatrixXd& covariance, Identification& identification) {
  PhysicalModel& physical = *identification.physical;
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < model.free.size(); ++i) {
    const Eigen::Index place = model.free[i].column;
    const auto own = static_cast<Eigen::Index>(i);
    SetValue(by[place], covariance(own, own), physical.parameters[static_cast<std::size_t>(place)]);
    places.push_back(place);
  }
  physical.covariance(places, places) = covariance;
  Eigen::MatrixXd of_free = Eigen::MatrixXd::Zero(by.size(), by.size());
  of_free(places, places) = covariance;
  const auto coefficients_of = [&](const FossenVector& parameters) {
    const Eigen::VectorXd all = CoefficientsOf(parameters, physical.propeller_separation_m);
    return Eigen::VectorXd(all.head(all.size() - 1));  // without the time constant
  };
  identification.covariance = ImpliedCovariance(by, of_free, coefficients_of);
  const Eigen::VectorXd implied = coefficients_of(by);
  for (Eigen::Index i = 0; i < identification.covariance.rows(); ++i) {
    SetValue(implied[i], identification.covariance(i, i),
             identification.coefficients[static_cast<std::size_t>(i)]);
  }
}

}  // namespace

AugmentedModel Reidentified(const EffectFit& fit, const DiagnosisProblem& problem,
                            const UncertainModel& model) {
  const Eigen::VectorXd change = ChangeBy(RecalibrationOf(fit, problem), problem.nominal, model);
  return AugmentedModel{model.Changed(change), problem.nominal.boat.effects}.With(fit.effects);
}

Identification Augmented(const Identification& old, const AugmentedModel& boat,
                         const EffectFit& fit, const DiagnosisProblem& problem,
                         const UncertainModel& model) {
  Identification augmented = old;
  const ResidualMetric::Recalibration recalibration = RecalibrationOf(fit, problem);
  const Eigen::MatrixXd covariance = Scaled(recalibration.covariance, model.StandardErrors());
  if (model.physical) {
    ReplacePhysicalParameters(
        model.ChangedParameters(ChangeBy(recalibration, problem.nominal, model)), model, covariance,
        augmented);
  } else {
    ReplaceCoefficients(boat.model, model, covariance, augmented);
  }
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
