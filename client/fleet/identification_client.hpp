#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/wait_set.hpp"
#include "bus/writer.hpp"
#include "codec/messages.hpp"

namespace telltale {

/// How asking the daemon ended. kNoDaemon: nobody on this domain takes requests. kTimedOut: there
/// is a daemon, but no reply came. The rest is the daemon's own answer.
enum class ExchangeOutcome { kUnknown, kNoDaemon, kTimedOut, kRefused, kFailed, kPublished };

struct IdentifyAnswer {
  ExchangeOutcome outcome = ExchangeOutcome::kUnknown;
  std::optional<IdentifyReply> reply;  ///< the daemon's answer, where there is one
};

struct ExchangeTiming {
  std::chrono::nanoseconds match = std::chrono::seconds(5);    ///< to find a daemon
  std::chrono::nanoseconds reply = std::chrono::seconds(120);  ///< from the request to its reply
  std::chrono::nanoseconds retry = std::chrono::seconds(1);  ///< silence after which it asks again
};

/// A correlation id nobody else will choose.
std::string NewCorrelationId();

/// Asks the daemon for identifications. A request is sent once this client's ends are connected,
/// and again under the same correlation id while the daemon is silent; the daemon answers an id
/// once.
class IdentificationClient {
 public:
  explicit IdentificationClient(const Participant& participant);

  /// Blocks until the answer is there. `progress` runs on the calling thread.
  /// Requires: identifiers of 1..64 letters, digits, '.', '_' or '-'.
  IdentifyAnswer Identify(const IdentifyRequest& request, const ExchangeTiming& timing,
                          const std::function<void(const IdentifyProgress&)>& progress = {});

 private:
  const Participant& participant_;
  Writer<telltale_wire_IdentifyRequest> requests_;
  Reader<telltale_wire_IdentifyProgress> progress_;
  Reader<telltale_wire_IdentifyReply> replies_;
};

}  // namespace telltale
