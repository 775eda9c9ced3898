#include "telltale/core/estimation/weak_form/weak_form.hpp"

#include "telltale/core/base/contract.hpp"
#include "telltale/core/estimation/regression/entering_rows.hpp"

namespace telltale {
namespace {

/// Rows of one segment whose supports make up a cluster, by their centres.
std::vector<RowRange> CutClusters(const RowRange& segment, double sampling_period_s,
                                  double cluster_s) {
  const auto parts =
      static_cast<std::size_t>(ClustersIn(segment.size(), sampling_period_s, cluster_s));
  std::vector<RowRange> clusters;
  for (std::size_t i = 0; i < parts; ++i) {
    clusters.push_back({segment.begin + segment.size() * i / parts,
                        segment.begin + segment.size() * (i + 1) / parts});
  }
  return clusters;
}

TestFunctionSupports SupportsOf(const PreparedDataset& dataset, Equation equation,
                                const RegressionOptions& regression, const TestFunction& phi,
                                double cluster_s) {
  const EnteringRows entering(dataset, {&equation, 1}, regression);
  // Nearer to the ends of a segment the filter is one-sided and changes from row to row.
  const std::size_t margin = dataset.options.smoothing_half_width;
  TestFunctionSupports supports;
  for (const RowRange& segment : dataset.segments) {
    for (const RowRange& cluster : CutClusters(segment, dataset.sampling_period_s, cluster_s)) {
      const std::size_t before = supports.first_rows.size();
      for (std::size_t first = segment.begin + margin; first + phi.Rows() + margin <= segment.end;
           first += phi.stride) {
        const std::size_t centre = first + phi.Rows() / 2;
        if (centre < cluster.begin || centre >= cluster.end) continue;
        if (entering.All(first, phi.Rows())) supports.first_rows.push_back(first);
      }
      supports.clusters.push_back({before, supports.first_rows.size()});
    }
  }
  return supports;
}

}  // namespace

WeakProblem BuildWeakForm(const PreparedDataset& dataset, const RegressionOptions& regression,
                          const WeakFormOptions& options) {
  Require(dataset.options.preset == Preset::kRobust, "data prepared with one kernel");
  Require(dataset.sampling_period_s > 0.0, "a positive sampling period");
  Require(dataset.commands.size() == dataset.segments.size(), "the commands of every segment");
  WeakProblem problem;
  problem.parameterization = regression.parameterization;
  problem.dead_zone = regression.dead_zone;
  problem.recording_bias_terms = {regression.recording_bias, dataset.Recordings()};
  problem.phi = TestFunction::On(dataset.sampling_period_s, options);
  const double recorded_s = static_cast<double>(dataset.rows.size()) * dataset.sampling_period_s;
  const double cluster_s = ClusterLength(options.clusters, recorded_s);
  for (const Equation equation : kEquations) {
    problem.supports[IndexOf(equation)] =
        SupportsOf(dataset, equation, regression, problem.phi, cluster_s);
  }
  problem.clusters = problem.supports[0].clusters.size();
  return problem;
}

}  // namespace telltale
