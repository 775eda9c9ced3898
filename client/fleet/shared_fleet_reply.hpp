#pragma once

#include <optional>
#include <utility>

#include "telltale/idl/codec/fleet_slices.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"

namespace telltale {

/// The slices whose daemons have to answer a request: those of the vehicles it is about.
SliceSet SlicesAskedBy(const FleetRequest& request);

/// Those of the slices that `reply` says nothing of.
SliceSet UnansweredSlices(const FleetRequest& request, const FleetReply& reply);

/// One answer of the daemons that share a fleet, made of what each of them answers for its slices.
/// Of a daemon that was asked again the later answer counts. A failure counts only where no daemon
/// succeeds: most know nothing of a refresh or a request that is to be cancelled.
class SharedFleetReply {
 public:
  explicit SharedFleetReply(FleetRequest request) : request_(std::move(request)) {}

  void Add(const FleetReply& reply);

  /// Whether every daemon that is to answer has done so.
  bool IsComplete() const;

  /// What has been answered so far.
  const std::optional<FleetReply>& reply() const { return reply_; }

 private:
  const FleetRequest request_;
  std::optional<FleetReply> reply_;
};

}  // namespace telltale
