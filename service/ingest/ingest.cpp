#include "telltale/service/ingest/ingest.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include <pthread.h>

#include <spdlog/spdlog.h>

#include "telltale/client/bus/topics.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

// Vehicles send several samples a second, and a waiting client repeats its request every second: a
// connected reader that receives nothing for this long is broken.
constexpr auto kLongestSilence = std::chrono::seconds(30);

// To wake up costs as much as to take in several samples: what comes meanwhile is taken together. A
// reader holds 64 samples of a vehicle, which may send 32000 a second so.
constexpr auto kGatherTime = std::chrono::milliseconds(2);

// Instances of vehicles that have left the bus stay known until then.
constexpr std::size_t kMostKnown = 100'000;

/// A failed reply that names the fault. Nothing where the request has no id to answer to.
template <class Reply, class Wire>
std::optional<Reply> ReplyToUnreadable(const Wire& wire, const CodecError& fault) {
  const std::string_view correlation_id = wire.correlation_id == nullptr ? "" : wire.correlation_id;
  if (!IsVehicleId(correlation_id)) return std::nullopt;
  Reply reply;
  reply.correlation_id = correlation_id;
  if constexpr (!std::is_same_v<Reply, FleetReply>) {
    reply.vehicle_id =
        VehicleIdLike({wire.vehicle_id, strnlen(wire.vehicle_id, sizeof wire.vehicle_id)});
  }
  reply.outcome = ReplyOutcome::kFailed;
  reply.message = "the daemon cannot read the request: " + fault.Message();
  return reply;
}

}  // namespace

Ingest::Ingest(const Participant& participant, Fleet& fleet, bool require_partition,
               const IntakeLimits& limits, Handlers handlers)
    : fleet_(fleet),
      handlers_(std::move(handlers)),
      senders_(require_partition),
      intake_(limits),
      warning_limit_(5, std::chrono::seconds(10)),
      last_heartbeat_(Clock::now()),
      wait_set_(participant),
      gnss_(
          participant, wait_set_,
          [this](const auto& wire, auto writer, auto instance) {
            Route(Channel::kGnss, gnss_, wire, writer, instance);
          },
          kLongestSilence),
      heading_(
          participant, wait_set_,
          [this](const auto& wire, auto writer, auto instance) {
            Route(Channel::kHeading, heading_, wire, writer, instance);
          },
          kLongestSilence),
      thrusters_(
          participant, wait_set_,
          [this](const auto& wire, auto writer, auto instance) {
            Route(Channel::kThrusters, thrusters_, wire, writer, instance);
          },
          kLongestSilence),
      requests_(
          participant, wait_set_,
          [this](const auto& wire, auto client) {
            Submit<IdentifyReply>(wire, client, handlers_.identify, handlers_.answer_identify);
          },
          kLongestSilence),
      diagnose_requests_(
          participant, wait_set_,
          [this](const auto& wire, auto client) {
            Submit<DiagnoseReply>(wire, client, handlers_.diagnose, handlers_.answer_diagnose);
          },
          kLongestSilence),
      fleet_requests_(
          participant, wait_set_,
          [this](const auto& wire, auto client) {
            Submit<FleetReply>(wire, client, handlers_.fleet, handlers_.answer_fleet);
          },
          kLongestSilence),
      thread_([this] { Run(); }) {}

Ingest::~Ingest() {
  stopping_ = true;
  wait_set_.Wake();
  thread_.join();
}

void Ingest::Run() {
  pthread_setname_np(pthread_self(), "ingest");  // as `top -H` and debuggers show it
  try {
    auto next_heartbeat = Clock::now();
    bool has_received = false;
    while (!stopping_) {
      if (Clock::now() >= next_heartbeat) {
        next_heartbeat = Clock::now() + handlers_.heartbeat_period;
        Heartbeat(std::exchange(has_received, false));
      }
      if (!wait_set_.Wait(next_heartbeat - Clock::now())) continue;
      has_received = true;
      std::this_thread::sleep_for(kGatherTime);
    }
  } catch (const std::exception& error) {
    handlers_.failed(error);
  }
}

void Ingest::Heartbeat(bool has_received) {
  handlers_.heartbeat(has_received);
  const auto now = Clock::now();
  last_heartbeat_ = now;
  const auto reopen = [now](auto& reader, const char* what) {
    if (reader.ReopenIfSilent(now))
      spdlog::warn("the reader of {} is connected but receives nothing; it is opened again", what);
  };
  reopen(gnss_, "gnss");
  reopen(heading_, "heading");
  reopen(thrusters_, "thrusters");
  reopen(requests_, "identify requests");
  reopen(diagnose_requests_, "diagnose requests");
  reopen(fleet_requests_, "fleet requests");
  NoteMatches();
  handlers_.clients(Clients());
}

std::set<WriterHandle> Ingest::Clients() const {
  std::set<WriterHandle> clients = requests_.Writers();
  clients.merge(diagnose_requests_.Writers());
  return clients;
}

std::chrono::steady_clock::duration Ingest::Silence() const {
  return Clock::now() - last_heartbeat_.load();
}

void Ingest::NoteMatches() {
  const std::lock_guard lock(matches_mutex_);
  matches_.clear();
  const auto note = [this]<class Wire>(const WatchedReader<Wire>& reader) {
    matches_.push_back({kContract<Wire>.topic, reader.Matched()});
  };
  note(gnss_);
  note(heading_);
  note(thrusters_);
  note(requests_);
  note(diagnose_requests_);
  note(fleet_requests_);
}

std::array<std::uint64_t, kChannels.size()> Ingest::Received() const {
  std::array<std::uint64_t, kChannels.size()> received{};
  std::ranges::copy(received_, received.begin());
  return received;
}

std::vector<TopicConnections> Ingest::Matches() const {
  const std::lock_guard lock(matches_mutex_);
  return matches_;
}

template <class Wire>
void Ingest::Route(Channel channel, const WatchedReader<Wire>& reader, const Wire& wire,
                   WriterHandle writer, InstanceHandle instance) {
  ++received_[static_cast<std::size_t>(channel)];
  const auto telemetry = Decode(wire);
  if (!telemetry) {
    return RejectUnattributed(channel, UnattributedReason::kMalformedId, telemetry.error().value);
  }
  Boat* const boat = BoatOf(instance, telemetry->vehicle_id, channel);
  if (boat == nullptr) return;
  const auto partitions_of = [&reader](auto one) { return reader.PartitionsOf(one); };
  if (!senders_.MaySend(writer, telemetry->vehicle_id, partitions_of)) {
    return RejectUnattributed(channel, UnattributedReason::kForeignWriter, telemetry->vehicle_id);
  }
  TakeIn(*boat, channel, *telemetry);
}

/// Null where the vehicle is not served here. An instance is looked up by its name once.
Ingest::Boat* Ingest::BoatOf(InstanceHandle instance, std::string_view vehicle_id,
                             Channel channel) {
  const std::uint64_t generation = fleet_.Generation();
  if (generation != std::exchange(known_generation_, generation) || known_.size() >= kMostKnown) {
    known_.clear();
  }
  if (const auto known = known_.find(instance); known != known_.end()) return known->second;
  VehicleWindow* const window = fleet_.Find(vehicle_id);
  if (window != nullptr) {
    Boat& boat = boats_.try_emplace(window, Boat{window, intake_.NewStream()}).first->second;
    return known_[instance] = &boat;
  }
  if (!fleet_.IsServedElsewhere(vehicle_id)) {
    RejectUnattributed(channel, UnattributedReason::kUnknownVehicle, vehicle_id);
  }
  return nullptr;
}

template <class Sample>
void Ingest::TakeIn(Boat& boat, Channel channel, const Telemetry<Sample>& telemetry) {
  VehicleWindow& window = *boat.window;
  const auto now = Clock::now();
  if (intake_.Admits(boat.stream, window.vehicle().vehicle_id, channel, now)) {
    window.Add(telemetry.sequence_number, telemetry.sample, now);
  } else {
    window.Shed(channel, telemetry.sequence_number, telemetry.sample.time_s);
  }
  if (++boat.since_receipt < kSamplesPerReceipt) return;
  boat.since_receipt = 0;
  handlers_.received(window);
}

void Ingest::RejectUnattributed(Channel channel, UnattributedReason reason,
                                std::string_view detail) {
  fleet_.CountUnattributed(Name(channel), Name(reason));
  if (const auto not_shown = warning_limit_.Admit(Clock::now())) {
    spdlog::warn("{} sample rejected: {} '{}' ({} more not shown)", Name(channel), Name(reason),
                 detail, *not_shown);
  }
}

template <class Reply, class Wire, class Handler, class Answer>
void Ingest::Submit(const Wire& wire, WriterHandle client, const Handler& handler,
                    const Answer& answer) {
  auto request = Decode(wire);
  if (request) return handler(std::move(*request), client);
  if (auto reply = ReplyToUnreadable<Reply>(wire, request.error())) answer(std::move(*reply));
  if (const auto not_shown = warning_limit_.Admit(Clock::now())) {
    spdlog::warn("request rejected: {} ({} more not shown)", request.error().Message(), *not_shown);
  }
}

}  // namespace telltale
