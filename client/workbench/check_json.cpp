#include "telltale/client/workbench/check_json.hpp"

#include <cstddef>

#include <nlohmann/json.hpp>

namespace telltale {
namespace {

nlohmann::ordered_json JsonOf(const Refusal& refusal) {
  return {{"subject", refusal.subject}, {"reason", refusal.reason}, {"advice", refusal.advice}};
}

nlohmann::ordered_json JsonOf(const Coefficient& delay) {
  return {{"estimate", delay.estimate},
          {"standardError", delay.standard_error},
          {"interval",
           {{"level", delay.interval.level},
            {"lower", delay.interval.lower},
            {"upper", delay.interval.upper}}},
          {"unit", delay.unit},
          {"status", std::string(Name(delay.status))}};
}

nlohmann::ordered_json JsonOf(const Result<ChannelDelays>& delays) {
  if (!delays) return {{"unknown", JsonOf(delays.error())}};
  nlohmann::ordered_json json = {{"clock", std::string(Name(Channel::kHeading))},
                                 {"commands", JsonOf(delays->commands)},
                                 {"fixes", JsonOf(delays->fixes)},
                                 {"startS", delays->start_s},
                                 {"endS", delays->end_s}};
  if (delays->warning) json["warning"] = JsonOf(*delays->warning);
  return json;
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
  json["missing"] = nlohmann::ordered_json::array();
  for (const Refusal& channel : log.lacks) json["missing"].push_back(JsonOf(channel));
  json["rejected"] = nlohmann::ordered_json::array();
  const RejectCounts rejected = log.rejected.value_or(RejectCounts{});
  for (const RejectReason reason : kRejectReasons) {
    if (rejected.Of(reason) == 0) continue;
    json["rejected"].push_back(
        {{"reason", std::string(Name(reason))}, {"count", rejected.Of(reason)}});
  }
  json["faults"] = nlohmann::ordered_json::array();
  for (const Refusal& fault : log.check.faults) json["faults"].push_back(JsonOf(fault));
  if (log.unusable) json["unusable"] = JsonOf(*log.unusable);
  json["delays"] = JsonOf(log.delays);
  return json;
}

}  // namespace

std::string PrintCheckJson(const std::vector<CheckedLog>& logs) {
  nlohmann::ordered_json json = {{"logs", nlohmann::ordered_json::array()}};
  for (const CheckedLog& log : logs) json["logs"].push_back(JsonOf(log));
  return json.dump(2) + '\n';
}

}  // namespace telltale
