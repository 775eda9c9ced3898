#pragma once

#include <functional>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/client/fleet/shared_fleet_reply.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"

namespace telltale {

using FleetResult = ReplyResult<FleetReply>;

/// Asks the daemon for what concerns several vehicles or their earlier models, or the daemons that
/// share the fleet.
class FleetClient {
 public:
  explicit FleetClient(const Participant& participant) : request_reply_(participant) {}

  /// Blocks until the answer is there. Where not all daemons have answered in time, it is what the
  /// others say, and UnansweredSlices() has something. `progress` runs on the calling thread.
  /// Requires: identifiers of 1..64 letters, digits, '.', '_' or '-'.
  FleetResult Ask(const FleetRequest& request, const RequestTiming& timing,
                  const std::function<void(const FleetProgress&)>& progress = {}) {
    SharedFleetReply shared(request);
    FleetResult last = request_reply_.Ask<FleetReply, FleetProgress>(
        request, timing, progress, [&shared](const FleetReply& reply) {
          shared.Add(reply);
          return shared.IsComplete();
        });
    if (!shared.reply() || last.unreadable) return last;
    return {OutcomeOf(shared.reply()->outcome), shared.reply(), std::nullopt};
  }

 private:
  RequestReply<telltale_wire_FleetRequest, telltale_wire_FleetProgress, telltale_wire_FleetReply>
      request_reply_;
};

}  // namespace telltale
