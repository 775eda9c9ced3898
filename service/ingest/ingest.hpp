#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <vector>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/watched_reader.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"
#include "telltale/idl/codec/messages/telemetry.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/ingest/intake.hpp"
#include "telltale/service/ingest/senders.hpp"
#include "telltale/service/ingest/topic_connections.hpp"

namespace telltale {

/// A receipt is due after so many samples of a vehicle: half of what a reader holds until it is
/// taken, so that a sender that waits for receipts overruns no reader.
inline constexpr std::size_t kSamplesPerReceipt = 32;

/// The one thread that takes samples from the bus. It adds telemetry to the vehicles' windows and
/// passes requests to their handlers. It does not estimate, and does not wait for estimates.
class Ingest {
 public:
  struct Handlers {
    std::function<void(IdentifyRequest, WriterHandle client)> identify;  ///< must return at once
    std::function<void(DiagnoseRequest, WriterHandle client)> diagnose;  ///< likewise
    std::function<void(FleetRequest, WriterHandle client)> fleet;        ///< likewise
    /// Sends the answer to a request that cannot be read.
    std::function<void(const IdentifyReply&)> answer_identify;
    std::function<void(const DiagnoseReply&)> answer_diagnose;
    std::function<void(const FleetReply&)> answer_fleet;
    /// Every heartbeat period while the loop runs; it says whether anything was received since.
    std::function<void(bool has_received)> heartbeat;
    /// Likewise: the clients whose requests reach this daemon now; must return at once.
    std::function<void(const std::set<WriterHandle>&)> clients;
    std::chrono::nanoseconds heartbeat_period = std::chrono::seconds(1);
    /// After every kSamplesPerReceipt samples of a vehicle; must return at once.
    std::function<void(VehicleWindow&)> received;
    std::function<void(const std::exception&)> failed;  ///< the loop has ended with a fault
  };

  /// `require_partition`: as Senders.
  Ingest(const Participant& participant, Fleet& fleet, bool require_partition,
         const IntakeLimits& limits, Handlers handlers);
  Ingest(const Ingest&) = delete;
  Ingest& operator=(const Ingest&) = delete;
  ~Ingest();  ///< ends the thread

  /// The samples taken from the bus since the start, by channel. Any thread may call it, and the
  /// next one.
  std::array<std::uint64_t, kChannels.size()> Received() const;

  /// Since the latest heartbeat, or since the start.
  std::chrono::steady_clock::duration Silence() const;

  /// The connections of the last second.
  std::vector<TopicConnections> Matches() const;

 private:
  /// What the loop knows of one window's telemetry.
  struct Boat {
    VehicleWindow* window = nullptr;
    Intake::Stream stream;
    std::size_t since_receipt = 0;  ///< samples
  };

  void Run();
  void Heartbeat(bool has_received);
  void NoteMatches();
  std::set<WriterHandle> Clients() const;
  template <class Wire>
  void Route(Channel channel, const WatchedReader<Wire>& reader, const Wire& wire,
             WriterHandle writer, InstanceHandle instance);
  Boat* BoatOf(InstanceHandle instance, std::string_view vehicle_id, Channel channel);
  template <class Sample>
  void TakeIn(Boat& boat, Channel channel, const Telemetry<Sample>& telemetry);
  void RejectUnattributed(Channel channel, UnattributedReason reason, std::string_view detail);
  template <class Reply, class Wire, class Handler, class Answer>
  void Submit(const Wire& wire, WriterHandle client, const Handler& handler, const Answer& answer);

  Fleet& fleet_;
  Handlers handlers_;
  Senders senders_;
  Intake intake_;
  RateLimit warning_limit_;
  std::map<const VehicleWindow*, Boat> boats_;
  std::unordered_map<InstanceHandle, Boat*> known_;  ///< those of boats_, as of known_generation_
  std::uint64_t known_generation_ = 0;
  std::array<std::atomic<std::uint64_t>, kChannels.size()> received_{};  ///< by channel
  std::atomic<std::chrono::steady_clock::time_point> last_heartbeat_;
  mutable std::mutex matches_mutex_;
  std::vector<TopicConnections> matches_;
  WaitSet wait_set_;  // before the readers attached to it, so that it goes last
  WatchedReader<telltale_wire_GnssFix> gnss_;
  WatchedReader<telltale_wire_Heading> heading_;
  WatchedReader<telltale_wire_Thrusters> thrusters_;
  WatchedReader<telltale_wire_IdentifyRequest> requests_;
  WatchedReader<telltale_wire_DiagnoseRequest> diagnose_requests_;
  WatchedReader<telltale_wire_FleetRequest> fleet_requests_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
