#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "telltale/client/cli/coefficient_text.hpp"
#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/number_pair.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/client/workbench/model_gains.hpp"

namespace telltale {
namespace {

struct GainArguments {
  std::filesystem::path model_file;
  std::vector<std::string> deltas;  ///< "PORT,STARBOARD"
  OutputOptions output;
};

PropellerCommand CommandNamed(const std::string& text) {
  const auto [port, starboard] = NumberPair("--delta", text, "two shares as in 0.5,-0.2");
  if (std::abs(port) <= 1.0 && std::abs(starboard) <= 1.0) return {port, starboard};
  throw UsageError("--delta " + text + ": shares of full command lie in [-1, 1]");
}

std::vector<PropellerCommand> CommandsOf(const GainArguments& arguments) {
  std::vector<PropellerCommand> commands;
  for (const std::string& text : arguments.deltas) commands.push_back(CommandNamed(text));
  return commands;
}

struct Axis {
  const char* name;
  const char* continuous_unit;
  const char* discrete_unit;
};

constexpr std::array<Axis, 3> kAxes = {
    {{"surge", "m/s^2", "m/s"}, {"sway", "m/s^2", "m/s"}, {"yaw", "rad/s^2", "rad/s"}}};

std::vector<std::string> Row(const Identification& model, const CommandGain& command,
                             Equation equation) {
  const Axis& axis = kAxes[IndexOf(equation)];
  if (!model.Has(equation)) return {axis.name, "refused", "", "", "", ""};
  const auto place = static_cast<Eigen::Index>(IndexOf(equation));
  return {axis.name,
          Significant(command.gain.gain[place]),
          BoundsText(BoundsOf(model, command.gain, equation)),
          axis.continuous_unit,
          Significant(model.sampling_period_s * command.gain.gain[place]),
          axis.discrete_unit};
}

std::string GainTable(const Identification& model, const std::vector<CommandGain>& gains) {
  Table table({{"input gain", Align::kLeft},
               {"G / h", Align::kRight},
               {BoundsTitle(model), Align::kRight},
               {"", Align::kLeft},
               {"G", Align::kRight},
               {"", Align::kLeft}});
  for (const CommandGain& command : gains) {
    table.AddHeading("port " + Plain(command.delta.port) + ", starboard " +
                     Plain(command.delta.starboard) + " (" +
                     std::string(Name(RegionOf(command.delta))) + ')');
    for (const Equation equation : kEquations) table.AddRow(Row(model, command, equation));
  }
  return table.Render();
}

std::string SettlingText(const Identification& model) {
  if (!model.thruster_time_constant) return "";
  const Settling settling = SettlingOf(model);
  return Wrapped("1 % of an initial condition is left after " + Significant(settling.estimate_s) +
                 " s, " + BoundsTitle(model) + ' ' + BoundsText(settling.interval) + ".");
}

void PrintGains(const GainArguments& arguments) {
  const auto [model, gains] = GainsOf(LoadModel(arguments.model_file), CommandsOf(arguments));
  arguments.output.Write(PrintGainsJson(model, gains), [&model = model, &gains = gains] {
    std::string text = model.vehicle_id + ", h = " + Plain(model.sampling_period_s) + " s\n\n" +
                       GainTable(model, gains) + '\n';
    for (const std::string& note : NotesOn(model, gains)) text += Wrapped(note);
    return text + SettlingText(model);
  });
}

}  // namespace

void AddGain(CLI::App& telltale) {
  const auto arguments = std::make_shared<GainArguments>();
  CLI::App& command = *telltale.add_subcommand(
      "gain", "Prints the input gain of commands with bounds, and how soon thrust settles");
  AddModelFile(command, arguments->model_file);
  command
      .add_option("--delta", arguments->deltas,
                  "commands, shares of full command in [-1, 1] (default: a short catalogue)")
      ->type_name("PORT,STARBOARD");
  arguments->output.AddTo(command, "gain.json");
  command.footer(
      "G is the paper's input gain over one sampling period h, G / h the acceleration. The\n"
      "bounds of G are h times those of G / h. Coefficients are the values for simulation.\n"
      "Example: telltale gain --model model.json --delta 0.5,0.5 --delta 0.5,-0.2");
  command.callback([arguments] { PrintGains(*arguments); });
}

}  // namespace telltale
