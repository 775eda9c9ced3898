#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string_view>
#include <thread>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/watched_reader.hpp"
#include "telltale/idl/codec/wire/messages.hpp"
#include "telltale/service/ingest/fleet.hpp"

namespace telltale {

/// The one thread that takes from the bus: telemetry into the vehicles' windows, requests to
/// whoever answers them. It never estimates, and never waits for those who do.
class Ingest {
 public:
  struct Handlers {
    std::function<void(IdentifyRequest)> identify;      ///< must return at once
    std::function<void(DiagnoseRequest)> diagnose;      ///< likewise
    std::function<void()> heartbeat;                    ///< every second while the loop is at work
    std::function<void(const std::exception&)> failed;  ///< the loop has ended; nothing comes in
  };

  Ingest(const Participant& participant, Fleet& fleet, Handlers handlers);
  Ingest(const Ingest&) = delete;
  Ingest& operator=(const Ingest&) = delete;
  ~Ingest();  ///< ends the thread

 private:
  void Run();
  void Heartbeat();
  template <class Wire>
  void Route(Channel channel, const Wire& wire);
  void RejectUnattributed(Channel channel, UnattributedReason reason,
                          std::string_view detail);
  template <class Wire, class Handler>
  void Submit(const Wire& wire, const Handler& handler);

  Fleet& fleet_;
  Handlers handlers_;
  RateLimit warning_limit_;
  WaitSet wait_set_;  // before the readers attached to it, so that it goes last
  WatchedReader<telltale_wire_GnssFix> gnss_;
  WatchedReader<telltale_wire_Heading> heading_;
  WatchedReader<telltale_wire_Thrusters> thrusters_;
  WatchedReader<telltale_wire_IdentifyRequest> requests_;
  WatchedReader<telltale_wire_DiagnoseRequest> diagnose_requests_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
