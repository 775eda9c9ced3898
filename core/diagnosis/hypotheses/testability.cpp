#include "telltale/core/diagnosis/hypotheses/testability.hpp"

#include <cmath>
#include <string>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

namespace telltale {
namespace {

/// The free parameter whose whitened column has the largest cosine with `whitened`.
std::string MostSimilarParameter(const DiagnosisProblem& problem, const UncertainModel& model,
                                 const Eigen::VectorXd& whitened) {
  const Eigen::MatrixXd columns = problem.metric.WhitenColumns(problem.recording.by_coefficient);
  Eigen::Index most = 0;
  (columns.transpose() * whitened)
      .cwiseQuotient(columns.colwise().norm().transpose().cwiseMax(1e-12))
      .cwiseAbs()
      .maxCoeff(&most);
  return model.NameOf(static_cast<std::size_t>(most));
}

/// The whitened columns of an effect's parameters; none for a stochastic effect.
std::vector<Eigen::VectorXd> WhitenedColumns(const Effect& effect,
                                             const DiagnosisProblem& problem) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t j = 0; j < problem.parameter_refs.size(); ++j) {
    if (problem.parameter_refs[j].effect != &effect) continue;
    const auto column = static_cast<Eigen::Index>(j);
    columns.emplace_back(
        problem.metric.WhitenColumns(problem.recording.by_effect_parameter.col(column)).col(0));
  }
  return columns;
}

/// Root mean squares over an effect's parameters of the sigmas that their typical sizes show.
struct Sigmas {
  double marginalised = 0.0;    ///< with what may vary besides
  double unmarginalised = 0.0;  ///< with that known
};

Sigmas SigmasOf(const Effect& effect, const DiagnosisProblem& problem) {
  const std::vector<Eigen::VectorXd> whitened = WhitenedColumns(effect, problem);
  if (whitened.empty()) {
    const double sigmas = StochasticDetectability(effect, problem);
    return {sigmas, sigmas};
  }
  Sigmas squares;
  for (const Eigen::VectorXd& column : whitened) {
    const double sigmas = problem.metric.Sigmas(column);
    squares.marginalised += sigmas * sigmas;
    squares.unmarginalised += column.squaredNorm() / problem.metric.RowsPerObservation();
  }
  const auto count = static_cast<double>(whitened.size());
  return {std::sqrt(squares.marginalised / count), std::sqrt(squares.unmarginalised / count)};
}

/// "wind and waves".
std::string NamesOf(const PresentWeather& weather) {
  std::string names;
  for (const std::string& name : weather.fit.Names()) {
    names.append(names.empty() ? "" : " and ").append(name);
  }
  return names;
}

/// The free parameter that is most like the effect's first one; none for a stochastic effect.
std::string MostSimilarParameter(const Effect& effect, const DiagnosisProblem& problem,
                                 const UncertainModel& model) {
  const std::vector<Eigen::VectorXd> whitened = WhitenedColumns(effect, problem);
  return whitened.empty() ? "" : MostSimilarParameter(problem, model, whitened.front());
}

}  // namespace

EffectTestability TestabilityOf(const Effect& effect, const DiagnosisProblem& problem,
                                const PresentWeather& weather, const UncertainModel& model) {
  constexpr double kDetectable = kDiagnosis.testability.detectable_sigmas;
  const Sigmas in_calm = SigmasOf(effect, problem);
  const Sigmas sigmas = weather.IsCalm() ? in_calm : SigmasOf(effect, InWeather(problem, weather));
  EffectTestability one;
  one.effect = effect.Name();
  one.detectability = sigmas.marginalised;
  one.testability = sigmas.marginalised >= kDetectable      ? Testability::kTestable
                    : in_calm.unmarginalised >= kDetectable ? Testability::kMasked
                                                            : Testability::kNotExcited;
  if (one.testability == Testability::kMasked) {
    one.masked_by = in_calm.marginalised >= kDetectable
                        ? NamesOf(weather)
                        : MostSimilarParameter(effect, problem, model);
  }
  return one;
}

}  // namespace telltale
