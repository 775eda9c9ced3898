#include "telltale/core/estimation/weak_form/projection.hpp"

namespace telltale {

RegressorRows RowsOf(const PreparedDataset& dataset, const WeakProblem& problem,
                     const FilteredThrust& thrust, Equation equation) {
  const std::size_t columns = Regressors(equation, problem.parameterization).size();
  const std::size_t bias_terms = problem.recording_bias_terms.Count();
  RegressorRows rows(static_cast<Eigen::Index>(dataset.rows.size()),
                     static_cast<Eigen::Index>(columns + bias_terms));
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    for (std::size_t k = dataset.segments[s].begin; k < dataset.segments[s].end; ++k) {
      double* const row = rows.row(static_cast<Eigen::Index>(k)).data();
      FillRow(equation, problem.bodies[k], thrust.filtered[k], {row, columns});
      problem.recording_bias_terms.Fill(dataset.RecordingOf(s), dataset.rows[k].eta.psi_rad,
                                        {row + columns, bias_terms});
    }
  }
  return rows;
}

Eigen::MatrixXd Project(const WeakProblem& problem, const TestFunctionSupports& supports,
                        const RegressorRows& rows) {
  const Eigen::Index length = problem.phi.value.size();
  Eigen::MatrixXd projected(static_cast<Eigen::Index>(supports.first_rows.size()), rows.cols());
  Eigen::RowVectorXd sum(rows.cols());
  for (std::size_t k = 0; k < supports.first_rows.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(supports.first_rows[k]);
    sum.noalias() = problem.phi.value.transpose() * rows.middleRows(first, length);
    projected.row(static_cast<Eigen::Index>(k)) = sum;
  }
  return projected;
}

Eigen::VectorXd ProjectAcceleration(const WeakProblem& problem,
                                    const TestFunctionSupports& supports,
                                    const PreparedDataset& dataset, Equation equation) {
  Eigen::VectorXd projected(static_cast<Eigen::Index>(supports.first_rows.size()));
  for (std::size_t k = 0; k < supports.first_rows.size(); ++k) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < problem.phi.slope.size(); ++i) {
      const PreparedRow& row = dataset.rows[supports.first_rows[k] + static_cast<std::size_t>(i)];
      sum -= problem.phi.slope[i] * ComponentOf(row.nu, equation);
    }
    projected[static_cast<Eigen::Index>(k)] = sum;
  }
  return projected;
}

}  // namespace telltale
