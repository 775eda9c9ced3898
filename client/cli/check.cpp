#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "telltale/client/cli/commands.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/cli/table.hpp"
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

std::string TableOf(const CheckedLog& log) {
  Table table({{"channel", Align::kLeft},
               {"samples", Align::kRight},
               {"Hz", Align::kRight},
               {"from s", Align::kRight},
               {"to s", Align::kRight},
               {"gaps", Align::kRight},
               {"longest s", Align::kRight}});
  for (const Channel channel : kChannels) {
    const ChannelCheck& of = log.check.channels[static_cast<std::size_t>(channel)];
    table.AddRow({std::string(Name(channel)), std::to_string(of.samples), RateText(of),
                  Fixed(of.start_s, 1), Fixed(of.end_s, 1), std::to_string(of.gaps),
                  Fixed(of.longest_gap_s, 1)});
  }
  std::string text = log.path.string() + '\n';
  if (!log.summary.empty()) text += Wrapped(log.summary + ".", "  ");
  text += table.Render();
  text += Wrapped(Counted(log.rejected.Total(), "sample", "samples") + " rejected.");
  for (const Refusal& fault : log.check.faults) {
    text += Wrapped("Suspected fault, " + fault.subject + ": " + fault.reason + ".");
    text += Wrapped("To do: " + fault.advice + ".", "  ");
  }
  if (log.check.faults.empty() && log.unusable) {
    text += Wrapped("Not usable, " + log.unusable->subject + ": " + log.unusable->reason + ".");
  }
  if (log.check.faults.empty() && !log.unusable) {
    text += "No fault of input is seen.\n";
  }
  return text;
}

nlohmann::ordered_json JsonOf(const Refusal& refusal) {
  return {{"subject", refusal.subject}, {"reason", refusal.reason}, {"advice", refusal.advice}};
}

nlohmann::ordered_json JsonOf(const CheckedLog& log) {
  nlohmann::ordered_json json = {{"log", log.path.string()}};
  if (!log.summary.empty()) json["summary"] = log.summary;
  json["channels"] = nlohmann::ordered_json::array();
  for (const Channel channel : kChannels) {
    const ChannelCheck& of = log.check.channels[static_cast<std::size_t>(channel)];
    json["channels"].push_back({{"channel", std::string(Name(channel))},
                                {"samples", of.samples},
                                {"startS", of.start_s},
                                {"endS", of.end_s},
                                {"medianPeriodS", of.median_period_s},
                                {"gaps", of.gaps},
                                {"longestGapS", of.longest_gap_s}});
  }
  json["rejected"] = nlohmann::ordered_json::array();
  for (const RejectReason reason : kRejectReasons) {
    if (log.rejected.Of(reason) == 0) continue;
    json["rejected"].push_back(
        {{"reason", std::string(Name(reason))}, {"count", log.rejected.Of(reason)}});
  }
  json["faults"] = nlohmann::ordered_json::array();
  for (const Refusal& fault : log.check.faults) json["faults"].push_back(JsonOf(fault));
  if (log.unusable) json["unusable"] = JsonOf(*log.unusable);
  return json;
}

CheckedLog CheckOne(const std::filesystem::path& path, const LogInputs& inputs) {
  RawLog log = ReadShown(path, inputs.options);
  const Vehicle vehicle = inputs.NamesVehicle() ? LoadVehicle(inputs.vehicle_file)
                                                : DescribedOrUsualVehicle(log.description);
  return CheckLog(path, std::move(log.channels), log.description, vehicle);
}

void CheckLogs(const CheckArguments& arguments) {
  std::vector<CheckedLog> checked;
  for (const std::filesystem::path& path : arguments.inputs.logs) {
    checked.push_back(CheckOne(path, arguments.inputs));
  }
  nlohmann::ordered_json json = {{"logs", nlohmann::ordered_json::array()}};
  for (const CheckedLog& log : checked) json["logs"].push_back(JsonOf(log));
  arguments.output.Write(json.dump(2) + '\n', [&] {
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
  CLI::App& command = *telltale.add_subcommand(
      "check", "Says what logs hold, which faults of input they show, and whether they can answer");
  arguments->inputs.AddTo(command, command)->required();
  arguments->output.AddTo(command, "check.json");
  command.footer(
      "Exits 3 with the first fault. Without a vehicle file, and where the log does not describe "
      "its thrusters, 1100, 1500 and 1900 us are taken for full reverse, neutral and full "
      "forward.\n"
      "Example: telltale check --log run1 --vehicle boat.textproto");
  command.callback([arguments] { CheckLogs(*arguments); });
}

}  // namespace telltale
