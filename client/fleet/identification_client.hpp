#pragma once

#include <functional>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

using IdentifyResult = ReplyResult<IdentifyReply>;

/// Asks the daemon for identifications.
class IdentificationClient {
 public:
  explicit IdentificationClient(const Participant& participant) : request_reply_(participant) {}

  /// Blocks until the answer is there. `progress` runs on the calling thread.
  /// Requires: identifiers of 1..64 letters, digits, '.', '_' or '-'.
  IdentifyResult Identify(const IdentifyRequest& request, const RequestTiming& timing,
                          const std::function<void(const IdentifyProgress&)>& progress = {}) {
    return request_reply_.Ask<IdentifyReply, IdentifyProgress>(request, timing, progress);
  }

 private:
  RequestReply<telltale_wire_IdentifyRequest, telltale_wire_IdentifyProgress,
               telltale_wire_IdentifyReply>
      request_reply_;
};

}  // namespace telltale
