#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "exit_code.hpp"
#include "fit/unknown_odds.hpp"
#include "score/comparison.hpp"

namespace {

using blind::fit::Observation;

const std::vector<std::string> kBesideFaults = {"constant",       "log_unexplained_share",
                                                "log_misfit",     "log_median_misfit",
                                                "predictable",    "improbable_shape",
                                                "further_faults", "drift",
                                                "waves",          "spells"};
const std::vector<std::string> kBesideWeather = {"constant", "log_misfit", "predictable", "drift",
                                                 "waves"};

struct Arguments {
  std::vector<std::string> sets;
  std::vector<std::string> reports;
  double ridge = 2e-4;
  bool partial = false;
};

void AddOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--set-dir", arguments.sets, "a set, as blind_truth wrote it; several together")
      ->type_name("DIR")
      ->required()
      ->check(CLI::ExistingDirectory.description(""));
  app.add_option("--reports", arguments.reports,
                 "the folder of reports NNN.json of each set, with left-out/NNN.json beside them")
      ->type_name("DIR")
      ->required()
      ->check(CLI::ExistingDirectory.description(""));
  app.add_option("--ridge", arguments.ridge,
                 "times the squares of the weights, beside the mean loss (0 to 1)")
      ->type_name("SHARE")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0).description(""));
  app.add_flag("--partial", arguments.partial, "take the cases that have reports");
}

std::vector<Observation> Read(const Arguments& arguments) {
  if (arguments.sets.size() != arguments.reports.size()) {
    throw CLI::ValidationError(
        "--reports", "given " + std::to_string(arguments.reports.size()) + " times, --set-dir " +
                         std::to_string(arguments.sets.size()) + " times: once each");
  }
  std::vector<Observation> all;
  for (std::size_t i = 0; i < arguments.sets.size(); ++i) {
    const auto own = blind::fit::ObservationsOf(
        blind::score::ScoredCases(arguments.sets[i], arguments.reports[i], arguments.partial));
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void Print(const std::string& title, const std::vector<Observation>& observations,
           const std::vector<std::string>& regressors, double ridge) {
  const auto model = blind::fit::FitLogistic(observations, regressors, ridge);
  const auto others = std::ranges::count_if(observations, &Observation::is_another);
  const auto left_out = std::ranges::count_if(observations, &Observation::is_left_out);
  std::printf(
      "\n%s: %zu likeliest causes, %zu of them another than the true one, %zu without the "
      "true effect; mean loss %.4f\n\n| regressor | weight |\n|---|---|\n",
      title.c_str(), observations.size(), static_cast<std::size_t>(others),
      static_cast<std::size_t>(left_out), blind::fit::LogarithmicLoss(model, observations));
  for (const std::string& name : regressors) {
    std::printf("| %s | %.2f |\n", name.c_str(), model.weights.at(name));
  }
}

void Run(const Arguments& arguments) {
  std::vector<Observation> faults;
  std::vector<Observation> weather;
  for (const Observation& observation : Read(arguments)) {
    (observation.is_weather ? weather : faults).push_back(observation);
  }
  Print("Beside faults", faults, kBesideFaults, arguments.ridge);
  Print("Beside weather alone", weather, kBesideWeather, arguments.ridge);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Fits the odds of an unknown cause to development sets");
  app.footer(
      "It opens the labels, so give it development sets alone. A logistic regression of whether "
      "the likeliest cause is another than the true one, on the "
      "terms that reports give of these odds. The weights belong into "
      "core/diagnosis/diagnosis_constants.hpp.\n"
      "Example: blind_fit --set-dir set-61 --reports reports-61 --set-dir set-62 --reports "
      "reports-62");
  Arguments arguments;
  AddOptions(app, arguments);
  return blind::ExitCodeOf<blind::score::ReportsMissing>(app, "blind_fit", argc, argv,
                                                         [&] { Run(arguments); });
}
