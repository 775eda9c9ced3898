#include <CLI/CLI.hpp>
#include <string>

#include "baselines/best_bic.hpp"
#include "baselines/regressions.hpp"
#include "exit_code.hpp"
#include "telltale/client/recording/file_contents.hpp"

namespace {

struct Arguments {
  blind::DiagnosisInputFiles files;
  std::filesystem::path out;
  std::string name;
};

void Run(const Arguments& arguments) {
  const blind::DiagnosisInputs inputs = arguments.files.Load();
  const blind::ReferenceBasis basis(inputs);
  const auto write = [&](const char* method,
                         std::vector<blind::baselines::ScoredExplanation> explanations) {
    const std::filesystem::path folder = arguments.out / method;
    std::filesystem::create_directories(folder);
    telltale::WriteFile(folder / (arguments.name + ".json"),
                        ReportOf(std::move(explanations), basis));
  };
  write("best-bic", blind::baselines::BestBic(basis));
  write("stepwise", blind::baselines::Stepwise(basis));
  write("sparse", blind::baselines::Sparse(basis));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Names causes of a gap by simpler methods, for comparison");
  app.footer(
      "Writes DIR/best-bic/NAME.json, DIR/stepwise/NAME.json and DIR/sparse/NAME.json.\n"
      "Example: blind_baselines --log cases/001/log --vehicle boat.textproto --model model.json "
      "\\\n"
      "             --reference-log reference-1 --reference-log reference-2 --out baselines "
      "--name 001");
  Arguments arguments;
  arguments.files.AddTo(app);
  app.add_option("--out", arguments.out, "the folder of all methods' folders")
      ->type_name("DIR")
      ->required();
  app.add_option("--name", arguments.name, "of the reports")->type_name("NAME")->required();
  return blind::ExitCodeOf(app, "blind_baselines", argc, argv, [&] { Run(arguments); });
}
