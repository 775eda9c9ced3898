#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"

namespace telltale {

/// How asking the daemon ended. kNoDaemon: nobody on this domain takes requests. kTimedOut: there
/// is a daemon, but no reply came. kUnreadable: its reply came, with something in it that this
/// client does not take. The rest is the daemon's own answer.
enum class RequestOutcome {
  kUnknown,
  kNoDaemon,
  kTimedOut,
  kUnreadable,
  kRefused,
  kFailed,
  kPublished,
  kAnswered
};

/// The daemon's own answer as the outcome of asking.
RequestOutcome OutcomeOf(ReplyOutcome outcome);

template <class Reply>
struct ReplyResult {
  RequestOutcome outcome = RequestOutcome::kUnknown;
  std::optional<Reply> reply;            ///< the daemon's answer, where it can be read
  std::optional<CodecError> unreadable;  ///< what in it cannot be, where that is so
};

struct RequestTiming {
  /// To find a daemon: participants announce themselves every eight seconds unless configured
  /// otherwise, so that one announcement may be lost.
  std::chrono::nanoseconds match = std::chrono::seconds(12);
  std::chrono::nanoseconds reply = std::chrono::seconds(120);  ///< from the request to its reply
  /// Silence after which it asks again. It doubles with each answer that says only that the request
  /// waits, up to four times this.
  std::chrono::nanoseconds retry = std::chrono::seconds(1);
};

/// A correlation id nobody else will choose.
std::string NewCorrelationId();

/// The same request, for an answer within `patience`.
template <class Request>
Request WithDeadline(Request request, std::chrono::nanoseconds patience) {
  request.deadline_s = std::max(1e-3, std::chrono::duration<double>(patience).count());
  return request;
}

/// How long a busy daemon asks to be left alone.
inline std::chrono::nanoseconds BusyTime(const ExchangeReply& reply) {
  constexpr double kLongestS = 3600.0;
  return std::chrono::ceil<std::chrono::nanoseconds>(
      std::chrono::duration<double>(std::min(reply.retry_after_s, kLongestS)));
}

/// Asks the daemon over one triple of topics. A request is sent once this client's ends are
/// connected, and again under the same correlation id while the daemon is silent, and after the
/// time that a busy daemon names; the daemon answers an id once.
template <class RequestWire, class ProgressWire, class ReplyWire>
class RequestReply {
 public:
  explicit RequestReply(const Participant& participant)
      : participant_(participant),
        requests_(participant),
        progress_(participant),
        replies_(participant) {}

  /// Blocks until the answer is there. `progress` runs on the calling thread, and so does
  /// `completes`: it is given each answer, and false where another daemon is still to answer.
  template <class Reply, class Progress, class Request>
  ReplyResult<Reply> Ask(const Request& request, const RequestTiming& timing,
                         const std::function<void(const Progress&)>& progress,
                         const std::function<bool(const Reply&)>& completes = {});

 private:
  using Clock = std::chrono::steady_clock;

  const Participant& participant_;
  Writer<RequestWire> requests_;
  Reader<ProgressWire> progress_;
  Reader<ReplyWire> replies_;
};

template <class RequestWire, class ProgressWire, class ReplyWire>
template <class Reply, class Progress, class Request>
ReplyResult<Reply> RequestReply<RequestWire, ProgressWire, ReplyWire>::Ask(
    const Request& request, const RequestTiming& timing,
    const std::function<void(const Progress&)>& progress,
    const std::function<bool(const Reply&)>& completes) {
  if (!WaitForMatch(participant_, {requests_, replies_, progress_}, timing.match)) {
    return {RequestOutcome::kNoDaemon, std::nullopt, std::nullopt};
  }

  ReplyResult<Reply> result;
  const auto now = Clock::now();
  const auto deadline = now + timing.reply;
  auto next_request = now;
  auto silence = timing.retry;
  ReplyResult<Reply> busy{RequestOutcome::kTimedOut, std::nullopt, std::nullopt};
  WaitSet wait_set(participant_);
  wait_set.Attach(progress_, [&] {
    progress_.Take([&](const ProgressWire& sample) {
      const auto decoded = Decode(sample);
      if (!decoded || decoded->correlation_id != request.correlation_id) return;
      silence = std::min(2 * silence, 4 * timing.retry);
      next_request = Clock::now() + silence;
      if (progress) progress(*decoded);
    });
  });
  wait_set.Attach(replies_, [&] {
    replies_.Take([&](const ReplyWire& sample) {
      if (sample.correlation_id == nullptr || request.correlation_id != sample.correlation_id) {
        return;
      }
      auto decoded = Decode(sample);
      if (decoded && decoded->retry_after_s > 0.0) {
        next_request = Clock::now() + BusyTime(*decoded);
        busy = {RequestOutcome::kFailed, std::move(*decoded), std::nullopt};
      } else if (decoded) {
        if (completes && !completes(*decoded)) return;
        result = {OutcomeOf(decoded->outcome), std::move(*decoded), std::nullopt};
      } else {
        // The daemon answers an id once: to ask again would bring the same.
        result = {RequestOutcome::kUnreadable, std::nullopt, decoded.error()};
      }
    });
  });

  while (!result.reply && !result.unreadable) {
    if (Clock::now() >= deadline) {
      return busy;
    }
    if (Clock::now() >= next_request) {
      requests_.Write(Encode(WithDeadline(request, deadline - Clock::now())));
      next_request = Clock::now() + silence;
    }
    wait_set.Wait(std::min(next_request, deadline) - Clock::now());
  }
  return result;
}

}  // namespace telltale
