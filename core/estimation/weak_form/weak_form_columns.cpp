#include "telltale/core/estimation/weak_form/weak_form_columns.hpp"

#include <numeric>

namespace telltale {
namespace {

/// Whether each recording has a support.
std::vector<bool> RecordingsCovered(const PreparedDataset& dataset,
                                    const TestFunctionSupports& supports) {
  std::vector<bool> covered(dataset.Recordings(), false);
  std::size_t segment = 0;
  for (const std::size_t first : supports.first_rows) {
    while (first >= dataset.segments[segment].end) ++segment;
    covered[dataset.RecordingOf(segment)] = true;
  }
  return covered;
}

}  // namespace

std::array<std::vector<std::size_t>, 3> AllColumns(Parameterization parameterization) {
  std::array<std::vector<std::size_t>, 3> columns;
  for (const Equation equation : kEquations) {
    auto& of_this = columns[IndexOf(equation)];
    of_this.resize(Regressors(equation, parameterization).size());
    std::iota(of_this.begin(), of_this.end(), std::size_t{0});
  }
  return columns;
}

std::array<std::vector<std::size_t>, 3> WithRecordingBiasTerms(
    const PreparedDataset& dataset, const WeakProblem& problem,
    const std::array<std::vector<std::size_t>, 3>& columns,
    const std::vector<bool>& heading_varies) {
  auto all = columns;
  const std::size_t each = problem.recording_bias_terms.PerRecording();
  if (each == 0) return all;
  for (std::size_t j = 0; j < 3; ++j) {
    if (all[j].empty()) continue;
    const auto regressors = Regressors(kEquations[j], problem.parameterization);
    std::erase_if(all[j], [&](std::size_t column) { return regressors[column].name == "1"; });
    const std::vector<bool> covered = RecordingsCovered(dataset, problem.supports[j]);
    for (std::size_t recording = 0; recording < covered.size(); ++recording) {
      if (!covered[recording]) continue;
      const std::size_t terms = heading_varies[recording] ? each : 1;
      for (std::size_t term = 0; term < terms; ++term) {
        all[j].push_back(regressors.size() + recording * each + term);
      }
    }
  }
  return all;
}

}  // namespace telltale
