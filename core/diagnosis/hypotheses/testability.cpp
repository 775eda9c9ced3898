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

/// Root mean squares over an effect's parameters of the sigmas that their typical sizes show.
struct Sigmas {
  double marginalised = 0.0;    ///< with what coefficients take up
  double unmarginalised = 0.0;  ///< with the coefficients known
};

Sigmas SigmasOf(const Effect& effect, const DiagnosisProblem& problem,
                const std::vector<Eigen::VectorXd>& whitened) {
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

}  // namespace

std::vector<EffectTestability> TestabilityOf(const DiagnosisProblem& problem,
                                             const UncertainModel& model,
                                             std::span<const Effect* const> library) {
  constexpr double kDetectable = kDiagnosis.testability.detectable_sigmas;
  std::vector<EffectTestability> all;
  for (const Effect* effect : library) {
    const std::vector<Eigen::VectorXd> whitened = WhitenedColumns(*effect, problem);
    const Sigmas sigmas = SigmasOf(*effect, problem, whitened);
    EffectTestability& one = all.emplace_back();
    one.effect = effect->Name();
    one.detectability = sigmas.marginalised;
    one.testability = sigmas.marginalised >= kDetectable     ? Testability::kTestable
                      : sigmas.unmarginalised >= kDetectable ? Testability::kMasked
                                                             : Testability::kNotExcited;
    if (one.testability == Testability::kMasked && !whitened.empty()) {
      one.masked_by = MostSimilarParameter(problem, model, whitened.front());
    }
  }
  return all;
}

}  // namespace telltale
