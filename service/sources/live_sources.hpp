#pragma once

#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "telltale/client/bridge/live_source.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/monitoring/fleet_view.hpp"

namespace telltale {

/// Runs the sources of the configuration, each on a thread of its own. One that fails is told in
/// the log and to `view`, and tried again every five seconds; the daemon goes on.
class LiveSources {
 public:
  /// Requires: SourceFault() of each is empty. Assumes: participant and view outlive it.
  LiveSources(const Participant& participant, const std::vector<SourceSettings>& sources,
              FleetView& view);
  LiveSources(const LiveSources&) = delete;
  LiveSources& operator=(const LiveSources&) = delete;
  ~LiveSources();  ///< ends them

 private:
  /// One source, made anew after each failure.
  class Runner {
   public:
    Runner(const Participant& participant, SourceSettings settings, FleetView& view);
    Runner(const Runner&) = delete;
    Runner& operator=(const Runner&) = delete;
    ~Runner() { thread_.join(); }

    void Stop();

   private:
    void Run();
    void RunOnce();
    void Note(const std::string& fault);

    const Participant& participant_;
    const SourceSettings settings_;
    const std::string name_;
    FleetView& view_;
    std::string noted_;  ///< the fault that the log has
    std::mutex mutex_;   // of stopping_ and source_
    std::condition_variable wake_;
    bool stopping_ = false;
    std::unique_ptr<LiveSource> source_;
    std::thread thread_;
  };

  std::list<Runner> runners_;
};

}  // namespace telltale
