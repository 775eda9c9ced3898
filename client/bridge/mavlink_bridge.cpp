#include "telltale/client/bridge/mavlink_bridge.hpp"

#include <algorithm>
#include <utility>

#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

constexpr double kSilenceS = 2.0;
constexpr double kAskAgainS = 10.0;
/// More senders than these are no fleet on one port: what is known of their frames begins anew.
constexpr std::size_t kMostSendersKnown = 1024;

std::array<std::uint64_t, kChannels.size()> PublishedOf(const LiveMavlinkVehicle& live) {
  std::array<std::uint64_t, kChannels.size()> published{};
  for (const Channel channel : kChannels) {
    published[static_cast<std::size_t>(channel)] = live.Published(channel);
  }
  return published;
}

}  // namespace

std::string VehicleIdOf(const std::string& pattern, int system) {
  std::string vehicle_id = pattern;
  const std::string placeholder = kSystemPlaceholder;
  const std::size_t at = vehicle_id.find(placeholder);
  if (at != std::string::npos) {
    vehicle_id.replace(at, placeholder.size(), std::to_string(system));
  }
  return vehicle_id;
}

std::optional<std::string> MavlinkBridgeOptions::Fault() const {
  const bool one_for_each = vehicle_id.find(kSystemPlaceholder) != std::string::npos;
  if (!one_for_each && systems.size() != 1) {
    return vehicle_id + " names one vehicle: say which by one system id, or let it contain " +
           kSystemPlaceholder;
  }
  if (IsVehicleId(VehicleIdOf(vehicle_id, 255))) return std::nullopt;
  return vehicle_id + " must make " + std::string(kVehicleIdAllowed) + " once " +
         kSystemPlaceholder + " is replaced by the system id";
}

MavlinkBridge::Vehicle::Vehicle(const Participant& participant, const MavlinkBridgeOptions& options,
                                int system)
    : vehicle_id(VehicleIdOf(options.vehicle_id, system)),
      live(options.port_channel, options.starboard_channel, options.channels),
      publisher(participant, vehicle_id, TelemetryPublisher::Leave::kAtOnce) {}

MavlinkBridge::MavlinkBridge(const Participant& participant, MavlinkBridgeOptions options,
                             Send send, Report report)
    : participant_(participant),
      options_(std::move(options)),
      send_(std::move(send)),
      report_(std::move(report)) {}

void MavlinkBridge::Receive(const std::string& sender, std::span<const std::uint8_t> bytes,
                            bool whole, double arrival_s) {
  if (senders_.size() == kMostSendersKnown && !senders_.contains(sender)) senders_.clear();
  std::vector<std::uint8_t>& pending = senders_[sender].pending;
  pending.insert(pending.end(), bytes.begin(), bytes.end());
  const std::size_t done = frames_.Consume(
      pending, whole, [&](const MavlinkFrame& frame) { Take(sender, frame, arrival_s); });
  pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(done));
}

void MavlinkBridge::Take(const std::string& sender, const MavlinkFrame& frame, double arrival_s) {
  Vehicle* const vehicle = VehicleOf(sender, frame, arrival_s);
  if (vehicle == nullptr) return;
  // A frame of a message that is not known may be noise: it never opens a sequence.
  auto& gaps = senders_[sender].gaps;
  const std::pair<int, int> source(frame.system, frame.component);
  const bool checked = MavlinkCrcExtra(frame.message).has_value();
  if (checked || gaps.contains(source)) {
    vehicle->lost_frames += gaps[source].Take(frame.sequence, arrival_s);
  }
  if (!checked || frame.component != kMavlinkAutopilot) return;
  vehicle->last_heard_s = arrival_s;
  vehicle->live.Take(frame, arrival_s, [&](const RawSample& sample) {
    std::visit([&](const auto& one) { vehicle->publisher.Publish(one); }, sample);
  });
  if (frame.message == MavlinkCommandAck::kId) TakeAnswer(*vehicle, CommandAckOf(frame));
  SeeBoot(*vehicle);
  if (IsAskingDue(*vehicle, arrival_s)) Ask(*vehicle, frame.system, arrival_s);
}

MavlinkBridge::Vehicle* MavlinkBridge::VehicleOf(const std::string& sender,
                                                 const MavlinkFrame& frame, double arrival_s) {
  const int system = frame.system;
  if (system == 0 || (!options_.systems.empty() && !options_.systems.contains(system))) {
    return nullptr;
  }
  const bool speaks = MavlinkCrcExtra(frame.message) && frame.component == kMavlinkAutopilot;
  const auto found = vehicles_.find(system);
  if (found == vehicles_.end()) {
    if (!speaks) return nullptr;
    Vehicle& vehicle =
        *(vehicles_[system] = std::make_unique<Vehicle>(participant_, options_, system));
    Follow(vehicle, sender, frame, arrival_s);
    return &vehicle;
  }
  Vehicle& vehicle = *found->second;
  const bool is_silent = arrival_s - vehicle.last_heard_s > kSilenceS;
  if (vehicle.sender != sender && !is_silent) {
    if (vehicle.other_sender++ == 0) {
      report_(sender + " bears system id " + std::to_string(system) + " too, which " +
              vehicle.vehicle_id + " at " + vehicle.sender +
              " has: it is passed over; give each vehicle an id of its own (SYSID_THISMAV)");
    }
    return nullptr;
  }
  if (speaks && (vehicle.sender != sender || vehicle.silent)) {
    Follow(vehicle, sender, frame, arrival_s);
  }
  return vehicle.sender == sender ? &vehicle : nullptr;
}

void MavlinkBridge::Follow(Vehicle& vehicle, const std::string& sender, const MavlinkFrame& frame,
                           double arrival_s) {
  report_("system " + std::to_string(frame.system) + " at " + sender + " is " + vehicle.vehicle_id);
  vehicle.sender = sender;
  vehicle.version = frame.version;
  vehicle.last_heard_s = arrival_s;
  vehicle.silent = false;
  vehicle.asked_s.reset();
  vehicle.denials_told.clear();
}

void MavlinkBridge::SeeBoot(Vehicle& vehicle) {
  const std::uint64_t boots = vehicle.live.Boots();
  if (boots == vehicle.boots) return;
  if (vehicle.boots > 0) {
    report_("the autopilot of " + vehicle.vehicle_id + " has booted");
    vehicle.asked_s.reset();
    vehicle.denials_told.clear();
  }
  vehicle.boots = boots;
}

/// An answer does not say which interval it is about.
void MavlinkBridge::TakeAnswer(Vehicle& vehicle, const MavlinkCommandAck& answer) {
  const bool is_ours = answer.target_system == 0 || answer.target_system == kBridgeSystem;
  const std::string refusal = MavlinkRefusalName(answer.result);
  if (answer.command != kMavlinkSetMessageInterval || !is_ours || refusal.empty()) return;
  ++vehicle.denied;
  if (!vehicle.denials_told.insert(refusal).second) return;
  report_("the autopilot of " + vehicle.vehicle_id + " answers " + refusal +
          " to a request for a message interval: set the rates of its link there (SR0_*)");
}

bool MavlinkBridge::IsAskingDue(const Vehicle& vehicle, double now_s) const {
  if (options_.listen_only) return false;
  if (!vehicle.asked_s) return true;
  const double since_s = now_s - *vehicle.asked_s;
  if (since_s < kAskAgainS) return false;
  const auto is_slow = [&](Channel channel, double least_hz) {
    const std::uint64_t before = vehicle.published_when_asked[static_cast<std::size_t>(channel)];
    const double rate_hz = static_cast<double>(vehicle.live.Published(channel) - before) / since_s;
    return Takes(options_.channels, channel) && rate_hz < least_hz;
  };
  return is_slow(Channel::kHeading, options_.rate_hz / 2.0) ||
         is_slow(Channel::kThrusters, options_.rate_hz / 2.0) || is_slow(Channel::kGnss, 1e-3);
}

void MavlinkBridge::Ask(Vehicle& vehicle, int system, double now_s) {
  vehicle.asked_s = now_s;
  vehicle.published_when_asked = PublishedOf(vehicle.live);
  const auto target = static_cast<std::uint8_t>(system);
  for (const MavlinkRequest& request :
       MessageIntervalRequests(target, kMavlinkAutopilot, options_.rate_hz)) {
    SendTo(vehicle, request);
  }
  if (vehicle.live.PortChannel() && vehicle.live.StarboardChannel()) return;
  for (const MavlinkRequest& request : OutputFunctionRequests(target, kMavlinkAutopilot)) {
    SendTo(vehicle, request);
  }
}

void MavlinkBridge::EachSecond(double now_s) {
  std::set<std::string> greeted;
  for (const auto& [system, vehicle] : vehicles_) {
    if (!vehicle->silent && now_s - vehicle->last_heard_s > kSilenceS) {
      vehicle->silent = true;
      report_(vehicle->vehicle_id + " is silent");
    }
    if (options_.listen_only || !greeted.insert(vehicle->sender).second) continue;
    SendTo(*vehicle, GroundStationHeartbeat());
  }
}

void MavlinkBridge::SendTo(const Vehicle& vehicle, const MavlinkRequest& request) {
  send_(vehicle.sender, SerializeMavlinkFrame({vehicle.version, kBridgeSystem, kBridgeComponent,
                                               request.message, request.payload, sequence_++}));
}

std::vector<MavlinkVehicleCounts> MavlinkBridge::Counts() const {
  std::vector<MavlinkVehicleCounts> all;
  for (const auto& [system, vehicle] : vehicles_) {
    MavlinkVehicleCounts counts;
    counts.vehicle_id = vehicle->vehicle_id;
    counts.system = system;
    counts.published = PublishedOf(vehicle->live);
    for (const MavlinkReject reason : kMavlinkRejects) {
      counts.rejected[static_cast<std::size_t>(reason)] = vehicle->live.Rejected(reason);
    }
    counts.lost_frames = vehicle->lost_frames;
    counts.other_sender = vehicle->other_sender;
    counts.denied = vehicle->denied;
    all.push_back(std::move(counts));
  }
  return all;
}

}  // namespace telltale
