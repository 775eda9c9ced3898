#include "telltale/core/diagnosis/hypotheses/testability.hpp"

#include <cmath>
#include <string>

#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

namespace telltale {
namespace {

constexpr double kDetectableSigmas = 3.0;  // sigmas

std::string NameOf(const UncertainModel& model, Eigen::Index i) {
  const auto& [equation, column] = model.free[static_cast<std::size_t>(i)];
  const auto regressors = Regressors(equation, model.model.parameterization);
  return std::string(Name(equation)) + ' ' +
         std::string(regressors[static_cast<std::size_t>(column)].name);
}

/// The coefficient whose change looks most like the effect.
std::string MaskingCoefficient(const DiagnosisProblem& problem, const UncertainModel& model,
                               const Eigen::VectorXd& seen) {
  const Eigen::MatrixXd base = problem.metric.WhitenColumns(problem.recording.by_coefficient);
  Eigen::Index most = 0;
  (base.transpose() * seen)
      .cwiseQuotient(base.colwise().norm().transpose().cwiseMax(1e-12))
      .cwiseAbs()
      .maxCoeff(&most);
  return NameOf(model, most);
}

}  // namespace

std::vector<EffectTestability> TestabilityOf(const DiagnosisProblem& problem,
                                             const UncertainModel& model,
                                             std::span<const Effect* const> library) {
  std::vector<EffectTestability> all;
  for (const Effect* effect : library) {
    EffectTestability& one = all.emplace_back();
    one.effect = effect->Name();
    double alone = 0.0;
    double counted = 0.0;
    for (std::size_t j = 0; j < problem.parameter_refs.size(); ++j) {
      if (problem.parameter_refs[j].effect != effect) continue;
      const Eigen::VectorXd seen = problem.metric
                                       .WhitenColumns(problem.recording.by_effect_parameter.col(
                                           static_cast<Eigen::Index>(j)))
                                       .col(0);
      const double sigmas = problem.metric.Sigmas(seen);
      alone += seen.squaredNorm() / problem.metric.RowsPerObservation();
      one.detectability += sigmas * sigmas;
      counted += 1.0;
      if (one.masked_by.empty()) one.masked_by = MaskingCoefficient(problem, model, seen);
    }
    if (counted == 0.0) {
      one.detectability = StochasticDetectability(*effect, problem);
      alone = one.detectability;
    } else {
      one.detectability = std::sqrt(one.detectability / counted);
      alone = std::sqrt(alone / counted);
    }
    one.testability = one.detectability >= kDetectableSigmas ? Testability::kTestable
                      : alone >= kDetectableSigmas           ? Testability::kMasked
                                                             : Testability::kNotExcited;
    if (one.testability != Testability::kMasked) one.masked_by.clear();
  }
  return all;
}

}  // namespace telltale
