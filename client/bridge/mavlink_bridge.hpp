#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "telltale/client/bridge/live_mavlink_vehicle.hpp"
#include "telltale/client/bridge/mavlink_requests.hpp"
#include "telltale/client/bridge/mavlink_sequence_gaps.hpp"
#include "telltale/client/fleet/telemetry_publisher.hpp"
#include "telltale/client/recording/mavlink/mavlink_frames.hpp"

namespace telltale {

/// What stands for the system id in the pattern of vehicle ids.
inline constexpr const char* kSystemPlaceholder = "{system}";

struct MavlinkBridgeOptions {
  std::string vehicle_id = std::string("mavlink-") + kSystemPlaceholder;
  std::set<int> systems;                 ///< [1, 255]; empty: every vehicle that is heard
  std::optional<int> port_channel;       ///< [1, 16]; unset: by SERVOn_FUNCTION 73
  std::optional<int> starboard_channel;  ///< [1, 16]; unset: by SERVOn_FUNCTION 74
  ChannelChoice channels;
  double rate_hz = 10.0;     ///< asked of the autopilots, > 0
  bool listen_only = false;  ///< sends nothing at all

  /// What is wrong with the pattern of ids, with what is allowed: a pattern without {system} names
  /// one vehicle, and so takes one system.
  std::optional<std::string> Fault() const;
};

/// The vehicle id of a system, by the pattern.
std::string VehicleIdOf(const std::string& pattern, int system);

/// What has gone through of one vehicle, since it was first heard.
struct MavlinkVehicleCounts {
  std::string vehicle_id;
  int system = 0;
  std::array<std::uint64_t, kChannels.size()> published{};
  std::array<std::uint64_t, kMavlinkRejects.size()> rejected{};
  std::uint64_t lost_frames = 0;   ///< by their sequence numbers, of all its components
  std::uint64_t other_sender = 0;  ///< frames of this system from another sender, passed over
  std::uint64_t denied = 0;        ///< requests for message intervals
};

/// Carries the MAVLink streams of a link onto the bus: each autopilot (component 1) is a vehicle.
/// A vehicle is taken from one sender; another one that bears its system id is passed over until
/// the first has been silent for two seconds.
///
/// Unless it only listens, it sends as a ground station: a heartbeat a second, and requests for
/// message intervals and SERVOn_FUNCTION when a vehicle is first heard, when its autopilot has
/// booted, and every ten seconds while headings or outputs come at under half the rate asked for,
/// no position comes, or the thrusters' outputs are unknown. A request that the autopilot denies is
/// told and counted.
class MavlinkBridge {
 public:
  using Send = std::function<void(const std::string& sender, std::span<const std::uint8_t>)>;
  using Report = std::function<void(const std::string& what)>;

  MavlinkBridge(const Participant& participant, MavlinkBridgeOptions options, Send send,
                Report report);

  /// Bytes that arrived, in UTC seconds by a clock that never goes back. `whole`: nothing that
  /// follows belongs to them.
  void Receive(const std::string& sender, std::span<const std::uint8_t> bytes, bool whole,
               double arrival_s);

  /// Sends what is due. To be called once a second.
  void EachSecond(double now_s);

  std::vector<MavlinkVehicleCounts> Counts() const;
  const MavlinkDamage& Damage() const { return frames_.Damage(); }

 private:
  struct Sender {
    std::vector<std::uint8_t> pending;  ///< the beginning of a frame
    std::map<std::pair<int, int>, MavlinkSequenceGaps> gaps;
  };
  struct Vehicle {
    Vehicle(const Participant& participant, const MavlinkBridgeOptions& options, int system);

    std::string vehicle_id;
    LiveMavlinkVehicle live;
    TelemetryPublisher publisher;
    std::string sender;
    std::uint8_t version = 2;  ///< of its frames, and so of what is sent to it
    double last_heard_s = 0.0;
    bool silent = false;
    std::uint64_t lost_frames = 0;
    std::uint64_t other_sender = 0;
    std::uint64_t boots = 0;
    std::uint64_t denied = 0;
    std::set<std::string> denials_told;  ///< since it was followed or booted
    std::optional<double> asked_s;
    std::array<std::uint64_t, kChannels.size()> published_when_asked{};
  };

  void Take(const std::string& sender, const MavlinkFrame& frame, double arrival_s);
  Vehicle* VehicleOf(const std::string& sender, const MavlinkFrame& frame, double arrival_s);
  void Follow(Vehicle& vehicle, const std::string& sender, const MavlinkFrame& frame,
              double arrival_s);
  void SeeBoot(Vehicle& vehicle);
  void TakeAnswer(Vehicle& vehicle, const MavlinkCommandAck& answer);
  bool IsAskingDue(const Vehicle& vehicle, double now_s) const;
  void Ask(Vehicle& vehicle, int system, double now_s);
  void SendTo(const Vehicle& vehicle, const MavlinkRequest& request);

  const Participant& participant_;
  MavlinkBridgeOptions options_;
  Send send_;
  Report report_;
  MavlinkStream frames_;
  std::map<std::string, Sender> senders_;
  std::map<int, std::unique_ptr<Vehicle>> vehicles_;  ///< by system id
  std::uint8_t sequence_ = 0;
};

}  // namespace telltale
