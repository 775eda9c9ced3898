#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "inputs/reference_basis.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"

namespace {

constexpr int kUsageError = 2;
constexpr int kNoGap = 3;

struct Arguments {
  blind::DiagnosisInputFiles files;
  std::filesystem::path augmented;
  std::filesystem::path out;
};

/// Writes what there is to say and tells whether that is a closure.
bool Run(const Arguments& arguments) {
  const blind::DiagnosisInputs inputs = arguments.files.Load();
  const blind::ReferenceBasis basis(inputs);
  const telltale::AugmentedModel augmented =
      telltale::OrThrow(telltale::AugmentedModelOf(telltale::LoadModel(arguments.augmented)));
  const auto closure = basis.ClosureBy(augmented);
  if (!closure) return false;
  const nlohmann::json json{{"closure", *closure},
                            {"published", std::sqrt(basis.SquaredGap({inputs.model.model, {}}))},
                            {"before", std::sqrt(basis.SquaredGap(basis.nominal.boat))},
                            {"after", std::sqrt(std::max(basis.SquaredGap(augmented), 0.0))},
                            {"noiseFloor", std::sqrt(basis.floor.Squared(telltale::kAllChannels))}};
  telltale::WriteFile(arguments.out, json.dump(1) + '\n');
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Measures how much of the excess error a diagnosis' model explains on a recording it never "
      "saw");
  app.footer(
      "Errors are those of free runs of 5 s in nominal sigmas, as in report.json.\n"
      "Example: blind_realised --log cases/001/again --vehicle boat.textproto --model model.json "
      "\\\n"
      "             --reference-log reference-1 --reference-log reference-2 \\\n"
      "             --augmented reports/models/001.json --out reports/001.realised.json");
  Arguments arguments;
  arguments.files.AddTo(app);
  app.add_option("--augmented", arguments.augmented,
                 "the model identified again, as telltale diagnose --out-model writes it")
      ->type_name("FILE")
      ->required();
  app.add_option("--out", arguments.out, "where the closure goes")->type_name("FILE")->required();
  try {
    app.parse(argc, argv);
    if (Run(arguments)) return 0;
    std::cerr << "blind_realised: the recording has no gap to close\n";
    return kNoGap;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageError;
  } catch (const std::exception& error) {
    std::cerr << "blind_realised: " << error.what() << '\n';
    return 1;
  }
}
