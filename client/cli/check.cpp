#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/model_notes.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/workbench/check_json.hpp"
#include "telltale/client/workbench/check_log.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"

namespace telltale {
namespace {

struct CheckArguments {
  LogInputs inputs;
  OutputOptions output;
};

std::string RateText(const ChannelCheck& channel) {
  return channel.median_period_s > 0.0 ? Fixed(1.0 / channel.median_period_s, 1) : "-";
}

std::string ChannelTable(const InputCheck& check) {
  Table table({{"channel", Align::kLeft},
               {"samples", Align::kRight},
               {"Hz", Align::kRight},
               {"from s", Align::kRight},
               {"to s", Align::kRight},
               {"gaps", Align::kRight},
               {"longest s", Align::kRight}});
  for (const Channel channel : kChannels) {
    const ChannelCheck& of = check.channels[static_cast<std::size_t>(channel)];
    if (of.samples == 0) continue;
    table.AddRow({std::string(Name(channel)), std::to_string(of.samples), RateText(of),
                  Fixed(of.start_s, 1), Fixed(of.end_s, 1), std::to_string(of.gaps),
                  Fixed(of.longest_gap_s, 1)});
  }
  return table.Render();
}

std::string Paragraph(const std::string& what, const Refusal& refusal) {
  return Wrapped(what + ", " + refusal.subject + ": " + refusal.reason + ".") +
         Wrapped("To do: " + refusal.advice + ".", "  ");
}

bool IsUnknown(const Coefficient& delay) {
  return delay.status == CoefficientStatus::kPrior;
}

std::string DelayTable(const ChannelDelays& delays) {
  Table table({{"delay by the clock of the headings", Align::kLeft},
               {"s", Align::kRight},
               {"95 % from", Align::kRight},
               {"to", Align::kRight}});
  const auto add = [&](const char* what, const Coefficient& delay) {
    table.AddRow({what, IsUnknown(delay) ? "unknown" : Fixed(delay.estimate, 3),
                  Fixed(delay.interval.lower, 3), Fixed(delay.interval.upper, 3)});
  };
  add("commands act after their stamps", delays.commands);
  add("fixes are stamped late", delays.fixes);
  return table.Render();
}

std::string DelayText(const CheckedLog& log) {
  if (!log.delays) {
    const Refusal& unknown = log.delays.error();
    const std::string said =
        Wrapped("Delays between the channels are unknown: " + unknown.reason + ".");
    return log.unusable ? said : said + Wrapped("To do: " + unknown.advice + ".", "  ");
  }
  const ChannelDelays& delays = *log.delays;
  std::string text = DelayTable(delays);
  if (IsUnknown(delays.commands) || IsUnknown(delays.fixes)) {
    text += Wrapped(
        "Of an unknown delay the recording tells little: these bounds are what is "
        "expected of any boat. Steps and turns tell more.");
  }
  if (delays.warning) {
    text += Wrapped("These bounds may not hold: " + delays.warning->reason + ".") +
            Wrapped("To do: " + delays.warning->advice + ".", "  ");
  }
  return text + Wrapped("Delays are of " + Fixed(delays.start_s, 1) + " s to " +
                        Fixed(delays.end_s, 1) + " s.");
}

std::string TableOf(const CheckedLog& log) {
  std::string text = log.path.string() + '\n';
  if (!log.summary.empty()) text += Wrapped(log.summary + ".", "  ");
  if (log.lacks.size() < kChannels.size()) text += ChannelTable(log.check);
  for (const Refusal& channel : log.lacks) text += Paragraph("Missing", channel);
  if (log.rejected) {
    text += Wrapped(RejectedText(*log.rejected) + " rejected.");
  }
  for (const Refusal& fault : log.check.faults) text += Paragraph("Suspected fault", fault);
  if (log.check.faults.empty() && log.lacks.empty() && log.unusable) {
    text += Paragraph("Not usable", *log.unusable);
  }
  text += DelayText(log);
  if (log.check.faults.empty() && !log.unusable) {
    text += "No fault of input is seen.\n";
  }
  return text;
}

CheckedLog CheckOne(const std::filesystem::path& path, const LogInputs& inputs) {
  RawLog log = ReadShown(path, inputs.options);
  const Vehicle vehicle = inputs.NamesVehicle() ? LoadVehicle(inputs.vehicle_file)
                                                : DescribedOrUsualVehicle(log.description);
  ProgressLine line;
  return CheckLog(path, std::move(log), vehicle,
                  [&](std::string_view stage, double fraction) { line.Update(stage, fraction); });
}

void CheckLogs(const CheckArguments& arguments) {
  std::vector<CheckedLog> checked;
  for (const std::filesystem::path& path : arguments.inputs.logs) {
    checked.push_back(CheckOne(path, arguments.inputs));
  }
  arguments.output.Write(PrintCheckJson(checked), [&] {
    std::string text;
    for (const CheckedLog& log : checked) text += (text.empty() ? "" : "\n") + TableOf(log);
    return text;
  });
  for (const CheckedLog& log : checked) {
    if (auto problem = log.FirstProblem()) {
      problem->subject = log.path.string() + ' ' + problem->subject;
      throw RefusedError(*std::move(problem));
    }
  }
}

}  // namespace

void AddCheck(CLI::App& telltale) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App& command = *telltale.add_subcommand("check",
                                               "Says what logs hold, the delays between their "
                                               "channels, which faults of input they show, and "
                                               "whether they can answer");
  arguments->inputs.AddTo(command, command)->required();
  arguments->output.AddTo(command, "check.json");
  command.footer(
      "Exits 3 with the first fault or missing channel. Delays are those of the model that "
      "identify --structure fossen makes, of the ten minutes in which the commands change the "
      "most; they need a vehicle file. Without a vehicle file, and where the log does not describe "
      "its thrusters, 1100, 1500 and 1900 us are taken for full reverse, neutral and full "
      "forward.\n"
      "Example: telltale check --log run1 --vehicle boat.textproto");
  command.callback([arguments] { CheckLogs(*arguments); });
}

}  // namespace telltale
