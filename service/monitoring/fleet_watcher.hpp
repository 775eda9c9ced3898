#pragma once

#include <atomic>
#include <thread>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/watched_reader.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"

namespace telltale {

/// Follows the answers and diagnoses of the fleet on the bus, on a thread of its own, into a view.
class FleetWatcher {
 public:
  FleetWatcher(const Participant& participant, FleetView& view);
  FleetWatcher(const FleetWatcher&) = delete;
  FleetWatcher& operator=(const FleetWatcher&) = delete;
  ~FleetWatcher();  ///< ends the thread

 private:
  void Run();

  WaitSet wait_set_;  // before the readers attached to it, so that it goes last
  WatchedReader<telltale_wire_Diagnosis> diagnoses_;
  WatchedReader<telltale_wire_IdentifyProgress> identify_progress_;
  WatchedReader<telltale_wire_IdentifyReply> identify_replies_;
  WatchedReader<telltale_wire_DiagnoseProgress> diagnose_progress_;
  WatchedReader<telltale_wire_DiagnoseReply> diagnose_replies_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
