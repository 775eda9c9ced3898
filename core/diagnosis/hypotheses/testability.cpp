#include "telltale/core/diagnosis/hypotheses/testability.hpp"

#include <cmath>
#include <string>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

/// What an effect's parameters do to the errors, whitened; no column for a stochastic effect.
Eigen::MatrixXd WhitenedColumns(const Effect& effect, const DiagnosisProblem& problem) {
  const auto columns = ColumnsOf(effect, problem.parameter_refs);
  return problem.metric.WhitenColumns(problem.recording.by_effect_parameter(Eigen::all, columns));
}

/// The free parameter whose whitened column has the largest cosine with that of the effect's first;
/// none for a stochastic effect.
std::string MostSimilarParameter(const Effect& effect, const DiagnosisProblem& problem,
                                 const UncertainModel& model) {
  const Eigen::MatrixXd whitened = WhitenedColumns(effect, problem);
  if (whitened.cols() == 0) return "";
  const Eigen::MatrixXd columns = problem.metric.WhitenColumns(problem.recording.by_coefficient);
  Eigen::Index most = 0;
  (columns.transpose() * whitened.col(0))
      .cwiseQuotient(columns.colwise().norm().transpose().cwiseMax(1e-12))
      .cwiseAbs()
      .maxCoeff(&most);
  return model.NameOf(static_cast<std::size_t>(most));
}

/// Root mean squares over an effect's parameters of the sigmas that their typical sizes show.
struct Sigmas {
  double marginalised = 0.0;    ///< with what may vary besides
  double unmarginalised = 0.0;  ///< with that known
};

Sigmas SigmasOf(const Effect& effect, const DiagnosisProblem& problem) {
  const Eigen::MatrixXd whitened = WhitenedColumns(effect, problem);
  if (whitened.cols() == 0) {
    const double sigmas = StochasticDetectability(effect, problem);
    return {sigmas, sigmas};
  }
  Sigmas squares;
  for (Eigen::Index j = 0; j < whitened.cols(); ++j) {
    const double sigmas = problem.metric.Sigmas(whitened.col(j));
    squares.marginalised += sigmas * sigmas;
    squares.unmarginalised += whitened.col(j).squaredNorm() / problem.metric.RowsPerObservation();
  }
  const auto count = static_cast<double>(whitened.cols());
  return {std::sqrt(squares.marginalised / count), std::sqrt(squares.unmarginalised / count)};
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
                        ? Enumerated(weather.fit.Names())
                        : MostSimilarParameter(effect, problem, model);
  }
  return one;
}

}  // namespace telltale
