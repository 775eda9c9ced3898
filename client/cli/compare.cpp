#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/exit_codes.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/idl/codec/json/model_change.hpp"

namespace telltale {
namespace {

struct CompareArguments {
  std::vector<std::filesystem::path> models;
  OutputOptions output;
};

std::string ChangeTable(const ModelChange& change) {
  Table table({{"equation"},
               {"regressor"},
               {"symbol"},
               {"difference", Align::kRight},
               {"std. error", Align::kRight},
               {"sigma", Align::kRight},
               {"p alone", Align::kRight}});
  for (const CoefficientChange& c : change.coefficients) {
    const bool lag = c.equation == Equation::kUnknown;
    table.AddRow({lag ? "" : std::string(Name(c.equation)), lag ? "time constant" : c.regressor,
                  c.symbol, Significant(c.difference), Significant(c.standard_error, 3),
                  Fixed(c.Sigmas(), 1), Significant(c.p_value, 2)});
  }
  return table.Render();
}

std::string VerdictLine(const ModelChange& change) {
  return Wrapped("The second " + InWords(change) + ". Together: Wald statistic " +
                 Significant(change.statistic) + " over " +
                 Counted(change.degrees_of_freedom, "combination", "combinations") +
                 "; below p = " + Plain(kSignificantChange) + " models are called different.");
}

void CompareModels(const CompareArguments& arguments) {
  if (arguments.models.size() != 2)
    throw UsageError("--model is needed twice: the earlier, the later");
  const Identification earlier = LoadModel(arguments.models[0]);
  const Identification later = LoadModel(arguments.models[1]);
  if (earlier.vehicle_id != later.vehicle_id) {
    std::cerr << "note: the models are of " << earlier.vehicle_id << " and of " << later.vehicle_id
              << '\n';
  }
  if (WindowsOverlap(earlier, later)) {
    std::cerr << "note: by their clocks the windows of the two overlap; if they share data the "
                 "test does not hold\n";
  }
  const ModelChange change = OrThrow(ChangeBetween(earlier, later));
  arguments.output.Write(PrintChangeJson(change),
                         [&] { return ChangeTable(change) + '\n' + VerdictLine(change); });
}

}  // namespace

void AddCompare(CLI::App& telltale) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "compare", "Tells whether two models of a boat differ by more than their errors");
  command
      .add_option("--model", arguments->models,
                  "model.json, as identify writes it; twice, the earlier first")
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""))
      ->required();
  arguments->output.AddTo(command, "change.json");
  command.footer(
      "The models must rest on different data and have been identified with the same options.\n"
      "Example: telltale compare --model may.json --model june.json");
  command.callback([arguments] { CompareModels(*arguments); });
}

}  // namespace telltale
