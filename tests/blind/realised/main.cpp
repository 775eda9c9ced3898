#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "exit_code.hpp"
#include "inputs/reference_basis.hpp"
#include "telltale/client/recording/file_contents.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/core/diagnosis/hypotheses/augmented_identification.hpp"

namespace {

struct NoGap : std::runtime_error {
  NoGap() : std::runtime_error("the recording has no gap to close") {}
};

struct Arguments {
  blind::DiagnosisInputFiles files;
  std::filesystem::path augmented;
  std::filesystem::path out;
};

void Run(const Arguments& arguments) {
  const blind::DiagnosisInputs inputs = arguments.files.Load();
  const blind::ReferenceBasis basis(inputs);
  const telltale::AugmentedModel augmented =
      telltale::OrThrow(telltale::AugmentedModelOf(telltale::LoadModel(arguments.augmented)));
  const auto closure = basis.ClosureBy(augmented);
  if (!closure) throw NoGap();
  const nlohmann::json json{{"closure", *closure},
                            {"published", std::sqrt(basis.SquaredGap({inputs.model.model, {}}))},
                            {"before", std::sqrt(basis.SquaredGap(basis.nominal.boat))},
                            {"after", std::sqrt(std::max(basis.SquaredGap(augmented), 0.0))},
                            {"noiseFloor", std::sqrt(basis.floor.Squared(telltale::kAllChannels))}};
  telltale::WriteFile(arguments.out, json.dump(1) + '\n');
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
  return blind::ExitCodeOf<NoGap>(app, "blind_realised", argc, argv, [&] { Run(arguments); });
}
