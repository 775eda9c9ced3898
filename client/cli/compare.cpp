#include <filesystem>
#include <memory>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/regressor_words.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/workbench/compare_models.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/core/identification/model_comparison.hpp"
#include "telltale/idl/codec/json/model_change.hpp"

namespace telltale {
namespace {

struct CompareArguments {
  std::vector<std::filesystem::path> models;
  OutputOptions output;
};

std::string ChangeTable(const ModelChange& change) {
  Table table({{"in"},
               {"coefficient"},
               {"difference", Align::kRight},
               {"std. error", Align::kRight},
               {"sigma", Align::kRight},
               {"p", Align::kRight}});
  for (const CoefficientChange& c : change.coefficients) {
    const bool of_boat = c.equation == Equation::kUnknown;
    table.AddRow({of_boat ? "" : std::string(Name(c.equation)),
                  of_boat ? ParameterCell(c.symbol) : RegressorCell(c.equation, c.regressor),
                  Significant(c.difference), Significant(c.standard_error, 3), Fixed(c.Sigmas(), 1),
                  Significant(c.p_value, 2)});
  }
  return table.Render();
}

/// The answer in one line, then how it was found.
std::string AnswerText(const ModelChange& change) {
  const std::string told = InWords(change);
  return AnswerOf(change) + '\n' +
         Wrapped("The second " + told + (told.ends_with('?') ? " " : ". ") +
                 "Together: Wald statistic " + Significant(change.statistic) + " over " +
                 Counted(change.degrees_of_freedom, "combination", "combinations") +
                 "; models differ where p is below " + Plain(kSignificantChange) +
                 ". In the table, p is that of one coefficient alone.");
}

/// What each model simulates with, where that is not its estimates. The test compares estimates:
/// regularised values are shrunk, so that their difference has no covariance.
std::string SimulationValuesText(const Identification& earlier, const Identification& later) {
  if (earlier.simulation.empty() && later.simulation.empty()) return "";
  Table table({{"coefficient"},
               {"earlier", Align::kRight},
               {"later", Align::kRight},
               {"difference", Align::kRight},
               {"unit"}});
  for (std::size_t i = 0; i < earlier.coefficients.size(); ++i) {
    const Coefficient& c = earlier.coefficients[i];
    for (std::size_t j = 0; j < later.coefficients.size(); ++j) {
      const Coefficient& other = later.coefficients[j];
      if (other.equation != c.equation || other.regressor != c.regressor) continue;
      const double before = earlier.SimulationParameter(i);
      const double after = later.SimulationParameter(j);
      table.AddRow({std::string(Name(c.equation)) + ' ' + c.regressor, Significant(before),
                    Significant(after), Significant(after - before), c.unit});
    }
  }
  return '\n' +
         Wrapped(
             "Values for simulation. The test above compares the estimates, since regularised "
             "values have no covariance of their difference.") +
         table.Render();
}

void PrintComparison(const CompareArguments& arguments) {
  if (arguments.models.size() != 2)
    throw UsageError("--model is needed twice: the earlier, the later");
  const Identification earlier = LoadModel(arguments.models[0]);
  const Identification later = LoadModel(arguments.models[1]);
  const ModelChange change = CompareModels(earlier, later, PrintNote);
  arguments.output.Write(PrintChangeJson(change), [&] {
    return AnswerText(change) + '\n' + ChangeTable(change) + SimulationValuesText(earlier, later);
  });
}

}  // namespace

void AddCompare(CLI::App& telltale) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "compare", "Tests whether two models of a boat differ by more than their errors");
  command
      .add_option("--model", arguments->models,
                  "model.json, as identify writes it; twice, the earlier first")
      ->type_name("FILE")
      ->check(CLI::ExistingFile.description(""))
      ->required();
  arguments->output.AddTo(command, "change.json");
  command.footer(
      "The models must rest on different data and be identified with the same options.\n"
      "Example: telltale compare --model may.json --model june.json");
  command.callback([arguments] { PrintComparison(*arguments); });
}

}  // namespace telltale
