#include "telltale/client/bridge/ros2_bridge.hpp"

#include "telltale/client/bus/qos.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

/// More are no fleet: anybody can invent topics, and each vehicle costs three writers.
constexpr std::size_t kMostVehicles = 1000;

bool HoldsVehicle(const std::string& pattern) {
  return pattern.find(kVehiclePlaceholder) != std::string::npos;
}

}  // namespace

std::string Ros2BridgeOptions::Namespace() const {
  if (!name_space.empty()) return name_space;
  return HoldsVehicle(vehicle_id) ? std::string("/") + kVehiclePlaceholder : "/";
}

std::optional<std::string> Ros2BridgeOptions::Fault() const {
  if (auto fault = NamespaceFault(Namespace())) return "namespace: " + *fault;
  if (HoldsVehicle(Namespace()) != HoldsVehicle(vehicle_id)) {
    return "vehicle id: " + vehicle_id + " and namespace " + Namespace() + " must both contain " +
           kVehiclePlaceholder + ", or neither";
  }
  if (!IsVehicleId(VehicleIdOf(vehicle_id, "x"))) {
    return "vehicle id: " + vehicle_id + " must make " + std::string(kVehicleIdAllowed) + " once " +
           kVehiclePlaceholder + " is replaced";
  }
  return std::nullopt;
}

Ros2Bridge::Vehicle::Vehicle(const Participant& bus, const std::string& id,
                             const Ros2BridgeOptions& options, const Report& report)
    : publisher(bus, id, TelemetryPublisher::Leave::kAtOnce),
      live(
          options.source,
          [this](const RawSample& sample) {
            std::visit([this](const auto& one) { publisher.Publish(one); }, sample);
          },
          [id, report](const std::string& what) { report(id + ": " + what); }, options.channels) {}

Ros2Bridge::Ros2Bridge(const Participant& ros, const Participant& bus, Ros2BridgeOptions options,
                       Report report)
    : ros_(ros),
      bus_(bus),
      options_(std::move(options)),
      report_(std::move(report)),
      wait_set_(ros),
      publications_(ros) {
  wait_set_.Attach(publications_, [this] {
    publications_.Take([this](const Publication& publication) { Discover(publication); });
  });
}

void Ros2Bridge::Discover(const Publication& publication) {
  const auto topic = RosTopicOfDds(publication.topic);
  const auto type = RosTypeOfDds(publication.type);
  if (!topic || !type || !NamesRosTopic(options_.source, *topic, *type)) return;
  const std::pair key(*topic, *type);
  if (readers_.contains(key)) return;
  Vehicle* const vehicle = VehicleOf(*topic);
  if (vehicle == nullptr) return;
  const auto [found, is_new] =
      readers_.try_emplace(key, ros_, publication.topic, publication.type, RosSensorQos().get());
  SerializedReader& reader = found->second;
  wait_set_.Attach(reader, [this, vehicle, &reader, &key = found->first] {
    reader.Take([&](std::span<const std::uint8_t> bytes) {
      vehicle->live.Take(key.first, key.second, bytes, clock_.Now());
    });
  });
}

Ros2Bridge::Vehicle* Ros2Bridge::VehicleOf(const std::string& topic) {
  const auto name = VehicleInTopic(options_.Namespace(), topic);
  if (!name) return nullptr;
  const std::string id = VehicleIdOf(options_.vehicle_id, *name);
  const auto found = vehicles_.find(id);
  if (found != vehicles_.end()) return found->second.get();
  if (!IsVehicleId(id) || vehicles_.size() == kMostVehicles) {
    if (left_out_.size() < kMostVehicles && left_out_.insert(id).second) {
      report_(topic + " is left out: " + id +
              (IsVehicleId(id) ? " is one vehicle too many" : " is no vehicle id"));
    }
    return nullptr;
  }
  report_(topic + " is of " + id);
  auto& vehicle = vehicles_[id];
  vehicle = std::make_unique<Vehicle>(bus_, id, options_, report_);
  return vehicle.get();
}

std::vector<RosVehicleCounts> Ros2Bridge::Counts() const {
  std::vector<RosVehicleCounts> all;
  for (const auto& [id, vehicle] : vehicles_) {
    RosVehicleCounts counts;
    counts.vehicle_id = id;
    for (const Channel channel : kChannels) {
      counts.published[static_cast<std::size_t>(channel)] = vehicle->live.Published(channel);
    }
    for (const RosReject reason : kRosRejects) {
      counts.rejected[static_cast<std::size_t>(reason)] = vehicle->live.Rejected(reason);
    }
    all.push_back(std::move(counts));
  }
  return all;
}

}  // namespace telltale
