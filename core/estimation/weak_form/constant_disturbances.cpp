#include "telltale/core/estimation/weak_form/constant_disturbances.hpp"

namespace telltale {
namespace {

/// Writes one equation's recording bias terms into the disturbances of their recordings.
void AddBiasTerms(const WeakProblem& problem, std::size_t index,
                  const std::vector<std::size_t>& columns, const Eigen::VectorXd& theta,
                  std::vector<ConstantDisturbance>& disturbances) {
  const std::size_t regressors = Regressors(kEquations[index], problem.parameterization).size();
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j] < regressors) continue;
    const std::size_t place = columns[j] - regressors;
    const std::size_t each = problem.recording_bias_terms.PerRecording();
    disturbances[place / each].terms(static_cast<Eigen::Index>(index),
                                     static_cast<Eigen::Index>(place % each)) =
        theta[static_cast<Eigen::Index>(j)];
  }
}

}  // namespace

std::vector<ConstantDisturbance> ConstantDisturbancesWith(const WeakProblem& problem,
                                                          const ProjectedEquations& equations,
                                                          const Thetas& thetas) {
  std::vector<ConstantDisturbance> disturbances(problem.recording_bias_terms.recordings);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    AddBiasTerms(problem, equations[i].index, equations[i].columns, thetas[i], disturbances);
  }
  return disturbances;
}

std::vector<ConstantDisturbance> ConstantDisturbancesOf(const WeakFit& fit,
                                                        const Eigen::VectorXd& theta) {
  std::vector<ConstantDisturbance> disturbances(fit.problem.recording_bias_terms.recordings);
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const auto [begin, size] = fit.BlockOf(j);
    AddBiasTerms(fit.problem, j, fit.equations[j]->columns, theta.segment(begin, size),
                 disturbances);
  }
  return disturbances;
}

}  // namespace telltale
