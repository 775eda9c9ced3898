#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/role.hpp"
#include "telltale/service/standby/election.hpp"
#include "telltale/service/standby/heard_requests.hpp"
#include "telltale/service/standby/mirror.hpp"
#include "telltale/service/standby/term_store.hpp"

namespace telltale {

/// How long a daemon may be silent.
std::chrono::nanoseconds LeaseOf(const StandbySettings& settings);

/// Lets daemons of one domain stand in for each other. Each publishes its status on
/// `telltale/daemon` and asserts its liveliness from its working loop, so that one that hangs is
/// replaced as one that died is. The standby keeps what the daemon that serves publishes, and
/// remembers the requests that nobody has answered. On a thread of its own.
class FailOver {
 public:
  struct Handlers {
    /// The daemon serves from now on, with writers of this ownership strength. `succeeds`: another
    /// has served before it.
    std::function<void(std::int32_t ownership_strength, bool succeeds)> take_over;
    std::function<void()> step_down;  ///< another serves; this daemon has to start again. Once
  };

  FailOver(const Participant& participant, const StandbySettings& settings, TermStore terms,
           Role& role, HeardRequests& requests, const Mirror::Into& mirrored, Handlers handlers);
  FailOver(const FailOver&) = delete;
  FailOver& operator=(const FailOver&) = delete;
  ~FailOver();  ///< ends the thread

  /// Begins to follow the others. From then on the handlers run, on the thread.
  void Start();

  /// Says that the loop this is called from is still at work, several times a lease, and whether it
  /// has received anything from boats or clients since the last time.
  void Heartbeat(bool has_heard_fleet);

  /// Whether another daemon has served since this one started. Any thread may call it.
  bool HasFollowed() const;

 private:
  using Clock = Election::Clock;

  void Run();
  void Follow();
  void FollowAnswers();
  void FollowProgress();
  void Decide();
  void NoteTerm(std::uint32_t term);
  void Keep(std::uint32_t term);
  void TakeOver();
  void StepDown(const std::string& why);
  void Publish(const DaemonStatus& status);
  DaemonStatus Self() const;

  const Clock::duration patience_;  ///< between two decisions
  Role& role_;
  HeardRequests& requests_;
  const Handlers handlers_;
  Writer<telltale_wire_DaemonStatus> status_writer_;
  WaitSet wait_set_;  // before the readers attached to it, so that it goes last
  Reader<telltale_wire_DaemonStatus> statuses_;
  Reader<telltale_wire_IdentifyReply> identify_replies_;
  Reader<telltale_wire_DiagnoseReply> diagnose_replies_;
  Reader<telltale_wire_FleetReply> fleet_replies_;
  Reader<telltale_wire_IdentifyProgress> identify_progress_;
  Reader<telltale_wire_DiagnoseProgress> diagnose_progress_;
  Reader<telltale_wire_FleetProgress> refresh_progress_;
  Mirror mirror_;

  mutable std::mutex mutex_;  // of election_
  Election election_;
  std::uint32_t followed_term_ = 0;  ///< of the thread
  TermStore terms_;                  ///< of the thread, once that runs
  std::atomic<bool> stepped_down_ = false;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
