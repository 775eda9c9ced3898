// Which estimator do the data choose, and do its bounds hold? Prints the second table of
// docs/validation/output-error.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "coverage/replicates.hpp"
#include "telltale/core/identification/identify.hpp"

namespace telltale::coverage {
namespace {

Scenario ScenarioOf(std::string name, double share) {
  Scenario scenario;
  scenario.name = std::move(name);
  scenario.environment = Disturbed(share);
  return scenario;
}

std::vector<Scenario> Scenarios() {
  std::vector<Scenario> all = {ScenarioOf("still", 0.0), ScenarioOf("hundredth", 0.01),
                               ScenarioOf("fiftieth", 0.02), ScenarioOf("tenth", 0.1),
                               ScenarioOf("rtk", 1.0)};
  Scenario surge = ScenarioOf("tenth-in-surge-alone", 0.0);
  surge.environment.disturbance_sigma[0] = 0.003;
  Scenario ten = ScenarioOf("still-ten-segments", 0.0);
  ten.mission.segments = 10;
  Scenario ten_tenth = ScenarioOf("tenth-ten-segments", 0.1);
  ten_tenth.mission.segments = 10;
  Scenario plain = ScenarioOf("still-plain-gnss", 0.0);
  plain.environment.position_noise_m = 0.10;
  plain.environment.heading_noise_deg = 0.5;
  Scenario coloured = ScenarioOf("still-coloured-gnss", 0.0);
  coloured.environment.position_drift_m = 0.2;
  Scenario bend = ScenarioOf("still-propeller-outside-class", 0.0);
  bend.boat.thrust_bend = 0.3;
  Scenario slight = ScenarioOf("still-propeller-slightly-outside", 0.0);
  slight.boat.thrust_bend = 0.02;
  all.insert(all.end(), {surge, ten, ten_tenth, plain, coloured, bend, slight});
  return all;
}

/// Share in percent of true coefficients within bounds.
double PercentCovered(const Identification& identification, const std::vector<double>& truth) {
  double held = 0.0;
  for (std::size_t j = 0; j < truth.size(); ++j) {
    const Interval& interval = identification.coefficients.at(j).interval;
    held += interval.lower <= truth[j] && truth[j] <= interval.upper ? 1.0 : 0.0;
  }
  return 100.0 * held / static_cast<double>(truth.size());
}

/// Geometric mean over the coefficients of how much wider the bounds of one are than of another.
double LogWidthRatio(const Identification& one, const Identification& other) {
  double sum = 0.0;
  for (std::size_t j = 0; j < one.coefficients.size(); ++j) {
    sum += std::log(one.coefficients[j].standard_error / other.coefficients[j].standard_error);
  }
  return sum / static_cast<double>(one.coefficients.size());
}

struct ReplicateResult {
  bool output_error = false;
  double chosen_coverage = 0.0;
  double weak_form_coverage = 0.0;
  double output_error_coverage = 0.0;
  double log_width_ratio = 0.0;
  double misspecification = 0.0;
};

std::optional<ReplicateResult> RunReplicate(const Scenario& scenario, std::uint64_t seed) {
  const Recording recording = Simulate(scenario, seed);
  const auto truth = CoefficientsOf(scenario.boat);
  IdentifyOptions options;
  options.seed = seed;
  const auto chosen = Identify(recording, VehicleOf(), options);
  options.estimator = Estimator::kOutputError;
  const auto by_name = Identify(recording, VehicleOf(), options);
  options.estimator = Estimator::kWeakIv;
  const auto weak = Identify(recording, VehicleOf(), options);
  if (!chosen || !by_name || !weak) return std::nullopt;
  return ReplicateResult{chosen->estimator == Estimator::kOutputError,
                         PercentCovered(*chosen, truth),
                         PercentCovered(*weak, truth),
                         PercentCovered(*by_name, truth),
                         LogWidthRatio(*weak, *by_name),
                         by_name->provenance.misspecification};
}

void PrintRow(const std::string& name, const std::vector<ReplicateResult>& replicates,
              std::size_t replicates_requested) {
  if (replicates.empty()) {
    std::printf("| %s | 0/%zu |\n", name.c_str(), replicates_requested);
    return;
  }
  const auto chose =
      std::count_if(replicates.begin(), replicates.end(),
                    [](const ReplicateResult& replicate) { return replicate.output_error; });
  std::printf("| %s | %zu/%zu | %ld | %.1f | %.1f | %.1f | %.2f | %.2f |\n", name.c_str(),
              replicates.size(), replicates_requested, static_cast<long>(chose),
              MeanOf(replicates, &ReplicateResult::chosen_coverage),
              MeanOf(replicates, &ReplicateResult::output_error_coverage),
              MeanOf(replicates, &ReplicateResult::weak_form_coverage),
              std::exp(MeanOf(replicates, &ReplicateResult::log_width_ratio)),
              MeanOf(replicates, &ReplicateResult::misspecification));
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  Campaign campaign;
  campaign.replicates = 24;
  CLI::App app("Which estimator the data choose, and how often bounds of 95 % hold the truth");
  campaign.AddOptionsTo(app, Scenarios());
  CLI11_PARSE(app, argc, argv);

  std::printf(
      "| scenario | answered | output error chosen | chosen: holds %% | output error %% | "
      "weak form %% | weak form wider by | ratio (54) |\n|---|---|---|---|---|---|---|---|\n");
  for (const Scenario& scenario : Scenarios()) {
    if (!campaign.IsSelected(scenario.name)) continue;
    const auto replicates =
        campaign.RunReplicates([&](std::uint64_t seed) { return RunReplicate(scenario, seed); });
    PrintRow(scenario.name, Completed(replicates), campaign.replicates);
  }
  return 0;
}

}  // namespace
}  // namespace telltale::coverage

int main(int argc, char** argv) {
  return telltale::coverage::Main(argc, argv);
}
