// Does a 95 % bound from output error hold 95 % of the time, with and without disturbance? Prints
// the table of docs/validation/output-error.md.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "coverage/replicates.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/estimation/output_error/output_error.hpp"
#include "telltale/core/estimation/output_error/output_error_covariance.hpp"
#include "telltale/core/estimation/weak_form/weak_iv.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale::coverage {
namespace {

std::vector<Scenario> Scenarios() {
  std::vector<Scenario> all(6);
  all[0].name = "rtk-still";
  all[1].name = "rtk";
  all[2].name = "rtk-still-lag";
  all[2].boat.thruster_time_constant_s = 0.4;
  all[3].name = "plain-gnss-still";
  all[3].environment.position_noise_m = 0.10;
  all[3].environment.heading_noise_deg = 0.5;
  all[4].name = "rtk-still-ten-segments";
  all[4].mission.segments = 10;
  all[5].name = "rtk-tenth";
  for (Scenario& scenario : all) {
    if (scenario.name.find("still") != std::string::npos)
      scenario.environment.disturbance_sigma = {};
  }
  for (double& sigma : all[5].environment.disturbance_sigma) sigma *= 0.1;
  return all;
}

/// The result of one replicate.
struct ReplicateResult {
  Eigen::VectorXd error;
  Eigen::VectorXd clustered;  ///< standard errors
  Eigen::VectorXd naive;
  double student = 0.0;
  double misfit = 0.0;
  double misspecification = 0.0;
  double seconds = 0.0;
};

std::optional<ReplicateResult> RunReplicate(const Scenario& scenario,
                                            const OutputErrorOptions& options, std::uint64_t seed) {
  const Recording recording = Simulate(scenario, seed);
  const auto dataset = Prepare(recording, VehicleOf(), {});
  if (!dataset) return std::nullopt;
  RegressionOptions regression;
  if (scenario.Lags()) regression.structure = Structure::kFirstOrderDynamic;
  const auto columns = AllColumns(Parameterization::kPropeller);
  const VesselModel start = StartOf(*dataset, regression, columns);
  const auto from = std::chrono::steady_clock::now();
  const auto fit = EstimateOutputError(*dataset, regression, columns, start, options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
  if (!fit) return std::nullopt;
  return ReplicateResult{fit->theta - TruthOf(scenario),
                         ClusterCovariance(*fit).diagonal().cwiseSqrt(),
                         NaiveCovariance(*fit).diagonal().cwiseSqrt(),
                         StudentQuantile(static_cast<double>(fit->scores.cols()) - 1.0, 0.975),
                         std::hypot(fit->position_misfit, fit->heading_misfit) / std::sqrt(2.0),
                         Misspecification(*fit),
                         took.count()};
}

/// Shares in percent of true values within bounds: mean, lowest and highest over coefficients.
struct CoverageSummary {
  double mean = 0.0;
  double lowest = 100.0;
  double highest = 0.0;
};

CoverageSummary SummariseCoverage(const std::vector<ReplicateResult>& replicates,
                                  Eigen::VectorXd ReplicateResult::*standard_errors) {
  CoverageSummary held;
  const Eigen::Index p = replicates.front().error.size();
  for (Eigen::Index j = 0; j < p; ++j) {
    double inside = 0.0;
    for (const ReplicateResult& replicate : replicates) {
      const double half = replicate.student * (replicate.*standard_errors)[j];
      inside += std::abs(replicate.error[j]) <= half ? 1.0 : 0.0;
    }
    const double percent = 100.0 * inside / static_cast<double>(replicates.size());
    held.mean += percent / static_cast<double>(p);
    held.lowest = std::min(held.lowest, percent);
    held.highest = std::max(held.highest, percent);
  }
  return held;
}

void PrintRow(const std::string& name, const std::vector<ReplicateResult>& replicates,
              std::size_t replicates_requested) {
  if (replicates.empty()) {
    std::printf("| %s | 0/%zu |\n", name.c_str(), replicates_requested);
    return;
  }
  const auto n = static_cast<double>(replicates.size());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(replicates.front().error.size());
  Eigen::VectorXd squares = mean;
  Eigen::VectorXd predicted = mean;
  for (const ReplicateResult& replicate : replicates) {
    mean += replicate.error / n;
    squares += replicate.error.cwiseAbs2() / n;
    predicted += replicate.clustered / n;
  }
  const Eigen::VectorXd spread = (squares - mean.cwiseAbs2()).cwiseMax(1e-30).cwiseSqrt();
  const CoverageSummary clustered = SummariseCoverage(replicates, &ReplicateResult::clustered);
  const CoverageSummary naive = SummariseCoverage(replicates, &ReplicateResult::naive);
  std::printf(
      "| %s | %zu/%zu | %.1f | %.1f | %.1f | %.1f | %.2f | %.2f | %.2f | %.2f | %.3f | %.2f |\n",
      name.c_str(), replicates.size(), replicates_requested, clustered.mean, clustered.lowest,
      clustered.highest, naive.mean, mean.cwiseAbs().cwiseQuotient(spread).mean(),
      predicted.cwiseQuotient(spread).mean(), MeanOf(replicates, &ReplicateResult::misfit),
      MeanOf(replicates, &ReplicateResult::misspecification), spread.mean(),
      MeanOf(replicates, &ReplicateResult::seconds));
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  Campaign campaign;
  campaign.replicates = 60;
  OutputErrorOptions options;
  CLI::App app("How often bounds from output error, nominally of 95 %, hold the truth");
  campaign.AddOptionsTo(app, Scenarios());
  app.add_option("--shooting-segment", options.shooting_segments.length_s,
                 "length of a shooting segment, s")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  std::printf(
      "| scenario | answered | cluster: mean %% | lowest %% | highest %% | naive: mean %% | "
      "bias/spread | predicted/spread | misfit | alarm | spread | s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Scenario& scenario : Scenarios()) {
    if (!campaign.IsSelected(scenario.name)) continue;
    const auto replicates = campaign.RunReplicates(
        [&](std::uint64_t seed) { return RunReplicate(scenario, options, seed); });
    PrintRow(scenario.name, Completed(replicates), campaign.replicates);
  }
  return 0;
}

}  // namespace
}  // namespace telltale::coverage

int main(int argc, char** argv) {
  return telltale::coverage::Main(argc, argv);
}
