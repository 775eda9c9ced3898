#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "telltale/client/bus/endpoint.hpp"
#include "telltale/client/bus/participant.hpp"

namespace telltale {

/// One thread's waiting place: sleeps until an attached endpoint has data, then runs its handler on
/// the waiting thread. Work belongs here, never in a DDS listener, where it deadlocks.
/// Only Wake may be called from other threads.
class WaitSet {
 public:
  explicit WaitSet(const Participant& participant);

  /// The endpoint must stay until it is detached or the wait set is gone.
  void Attach(const Endpoint& endpoint, std::function<void()> on_data);
  void Detach(const Endpoint& endpoint);

  /// Runs the handlers of all endpoints that have data. False when none had within `timeout`, or on
  /// Wake. A timeout below zero counts as zero: the deadline of a late caller has passed already.
  bool Wait(std::chrono::nanoseconds timeout);

  /// Ends the present or the next Wait early.
  void Wake();

 private:
  struct Attachment {
    dds_entity_t endpoint;
    std::function<void()> on_data;
  };

  Entity guard_;
  Entity wait_set_;  // after the guard attached to it, so that it goes first
  std::vector<std::unique_ptr<Attachment>> attachments_;
};

}  // namespace telltale
