#pragma once

#include <functional>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/fleet/exchange.hpp"
#include "telltale/idl/codec/messages.hpp"

namespace telltale {

using IdentifyAnswer = ExchangeAnswer<IdentifyReply>;

/// Asks the daemon for identifications.
class IdentificationClient {
 public:
  explicit IdentificationClient(const Participant& participant) : exchange_(participant) {}

  /// Blocks until the answer is there. `progress` runs on the calling thread.
  /// Requires: identifiers of 1..64 letters, digits, '.', '_' or '-'.
  IdentifyAnswer Identify(const IdentifyRequest& request, const ExchangeTiming& timing,
                          const std::function<void(const IdentifyProgress&)>& progress = {}) {
    return exchange_.Ask<IdentifyReply, IdentifyProgress>(request, timing, progress);
  }

 private:
  Exchange<telltale_wire_IdentifyRequest, telltale_wire_IdentifyProgress,
           telltale_wire_IdentifyReply>
      exchange_;
};

}  // namespace telltale
