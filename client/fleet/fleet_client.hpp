#pragma once

#include <cstdint>
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
  /// others say, and UnansweredSlices() has something. `progress` runs on the calling thread. It is
  /// told of the vehicles in each answer too: a daemon whose part of a refresh has ended sends no
  /// progress any more, and others may take long.
  /// Requires: identifiers of 1..64 letters, digits, '.', '_' or '-'.
  FleetResult Ask(const FleetRequest& request, const RequestTiming& timing,
                  const std::function<void(const FleetProgress&)>& progress = {}) {
    SharedFleetReply shared(request);
    FleetResult last = request_reply_.Ask<FleetReply, FleetProgress>(
        request, timing, progress, [&](const FleetReply& reply) {
          shared.Add(reply);
          if (progress && !reply.refreshed.empty()) {
            progress({reply.correlation_id, static_cast<std::uint32_t>(reply.refreshed.size()),
                      reply.refreshed});
          }
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
