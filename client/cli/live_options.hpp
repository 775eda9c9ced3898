#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include "telltale/client/cli/outcome.hpp"
#include "telltale/client/fleet/exchange.hpp"

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
};

/// `--vehicle-id`, checked.
CLI::Option* AddVehicleId(CLI::App& command, std::string& vehicle_id);

/// What is said where the daemon is there and does not answer.
std::string TimedOutText(const LiveOptions& live);

/// What to do where nobody answers on a domain.
std::string NobodyThereAdvice(std::uint32_t domain);

/// Throws: RefusedError where the daemon refused, std::runtime_error where nobody answers, it
/// failed or its answer cannot be read.
template <class Reply>
void RequirePublished(const ExchangeAnswer<Reply>& answer, const std::string& vehicle_id,
                      const LiveOptions& live) {
  switch (answer.outcome) {
    case ExchangeOutcome::kPublished: return;
    case ExchangeOutcome::kRefused:
      throw RefusedError(answer.reply->refusals.empty() ? Refusal{vehicle_id, "was refused", ""}
                                                        : answer.reply->refusals.front());
    case ExchangeOutcome::kNoDaemon:
      throw std::runtime_error("no daemon answers: " + NobodyThereAdvice(live.domain));
    case ExchangeOutcome::kTimedOut: throw std::runtime_error(TimedOutText(live));
    case ExchangeOutcome::kUnreadable:
      throw std::runtime_error(
          "the daemon's answer cannot be read: " + answer.unreadable->Message() +
          "; are client and daemon of one version?");
    case ExchangeOutcome::kFailed:
    case ExchangeOutcome::kUnknown: throw std::runtime_error(answer.reply->message);
  }
}

}  // namespace telltale
