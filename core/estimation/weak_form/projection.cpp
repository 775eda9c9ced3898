#include "telltale/core/estimation/weak_form/projection.hpp"

#include <iterator>
#include <vector>

#include "telltale/core/vessel/body_regressors.hpp"

namespace telltale {

namespace {

Eigen::Index ColumnsOf(const WeakProblem& problem, Equation equation) {
  return std::ssize(Regressors(equation, problem.parameterization)) +
         static_cast<Eigen::Index>(problem.recording_bias_terms.Count());
}

RegressorRows RowsOfSegment(const PreparedDataset& dataset, const WeakProblem& problem,
                            const FilteredThrust& thrust, Equation equation, std::size_t segment) {
  const RowRange& range = dataset.segments[segment];
  const std::size_t bias_terms = problem.recording_bias_terms.Count();
  RegressorRows rows(static_cast<Eigen::Index>(range.size()), ColumnsOf(problem, equation));
  const std::size_t columns = static_cast<std::size_t>(rows.cols()) - bias_terms;
  for (std::size_t k = range.begin; k < range.end; ++k) {
    double* const row = rows.row(static_cast<Eigen::Index>(k - range.begin)).data();
    FillRow(equation, NoiseCorrectedBodyRow(dataset.rows[k].nu, dataset.nu_noise),
            thrust.filtered[k], {row, columns});
    problem.recording_bias_terms.Fill(dataset.RecordingOf(segment), dataset.rows[k].eta.psi_rad,
                                      {row + columns, bias_terms});
  }
  return rows;
}

}  // namespace

Eigen::MatrixXd ProjectRegressors(const PreparedDataset& dataset, const WeakProblem& problem,
                                  const FilteredThrust& thrust, Equation equation) {
  const std::vector<std::size_t>& first_rows = problem.supports[IndexOf(equation)].first_rows;
  const Eigen::VectorXd& weights = problem.phi.value;
  Eigen::MatrixXd projected(std::ssize(first_rows), ColumnsOf(problem, equation));
  Eigen::RowVectorXd sum(projected.cols());
  std::size_t k = 0;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& segment = dataset.segments[s];
    const RegressorRows rows = RowsOfSegment(dataset, problem, thrust, equation, s);
    for (; k < first_rows.size() && first_rows[k] < segment.end; ++k) {
      const auto first = static_cast<Eigen::Index>(first_rows[k] - segment.begin);
      sum.noalias() = weights.transpose() * rows.middleRows(first, weights.size());
      projected.row(static_cast<Eigen::Index>(k)) = sum;
    }
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
