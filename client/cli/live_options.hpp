#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/client/workbench/errors.hpp"

namespace telltale {

/// What every subcommand that goes on the bus can be told.
struct LiveOptions {
  std::uint32_t domain = 0;
  double timeout_s = 0.0;

  /// `--domain`, and `--timeout` meaning what `timeout_help` says.
  void AddTo(CLI::App& command, double default_timeout_s, const std::string& timeout_help);

  std::chrono::nanoseconds Timeout() const {
    return std::chrono::ceil<std::chrono::nanoseconds>(std::chrono::duration<double>(timeout_s));
  }

  /// Of a request that is given up after the time-out, be it for want of a daemon or of a reply.
  RequestTiming Timing() const;
};

/// Checks a vehicle id or a correlation id.
CLI::Validator IdentifierText();

/// `--vehicle-id`, checked.
CLI::Option* AddVehicleId(CLI::App& command, std::string& vehicle_id);

/// What is said where the daemon is there and does not answer.
std::string TimedOutText(const LiveOptions& live);

/// What to do where nobody answers on a domain.
std::string NobodyThereAdvice(std::uint32_t domain);

/// Throws: RefusedError where the daemon refused, std::runtime_error where nobody answers, it
/// failed or its answer cannot be read. `vehicle_id` is the subject of a refusal without reasons.
template <class Reply>
void RequirePublished(const ReplyResult<Reply>& result, const std::string& vehicle_id,
                      const LiveOptions& live) {
  switch (result.outcome) {
    case RequestOutcome::kPublished:
    case RequestOutcome::kAnswered: return;
    case RequestOutcome::kRefused:
      throw RefusedError(result.reply->refusals.empty() ? Refusal{vehicle_id, "was refused", ""}
                                                        : result.reply->refusals.front());
    case RequestOutcome::kNoDaemon:
      throw std::runtime_error("no daemon answers: " + NobodyThereAdvice(live.domain));
    case RequestOutcome::kTimedOut: throw std::runtime_error(TimedOutText(live));
    case RequestOutcome::kUnreadable:
      throw std::runtime_error(
          "the daemon's answer cannot be read: " + result.unreadable->Message() +
          "; are client and daemon of one version?");
    case RequestOutcome::kFailed:
    case RequestOutcome::kUnknown: throw std::runtime_error(result.reply->message);
  }
}

}  // namespace telltale
