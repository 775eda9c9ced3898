#include "telltale/service/ingest/ingest.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

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
      wait_set_(participant),
      gnss_(
          participant, wait_set_,
          [this](const auto& wire, auto writer) { Route(Channel::kGnss, gnss_, wire, writer); },
          kLongestSilence),
      heading_(
          participant, wait_set_,
          [this](const auto& wire, auto writer) {
            Route(Channel::kHeading, heading_, wire, writer);
          },
          kLongestSilence),
      thrusters_(
          participant, wait_set_,
          [this](const auto& wire, auto writer) {
            Route(Channel::kThrusters, thrusters_, wire, writer);
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
  try {
    auto next_heartbeat = Clock::now();
    bool has_received = false;
    while (!stopping_) {
      if (Clock::now() >= next_heartbeat) {
        next_heartbeat = Clock::now() + handlers_.heartbeat_period;
        Heartbeat(std::exchange(has_received, false));
      }
      has_received |= wait_set_.Wait(next_heartbeat - Clock::now());
    }
  } catch (const std::exception& error) {
    handlers_.failed(error);
  }
}

void Ingest::Heartbeat(bool has_received) {
  handlers_.heartbeat(has_received);
  const auto now = Clock::now();
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
                   WriterHandle writer) {
  ++received_[static_cast<std::size_t>(channel)];
  const auto telemetry = Decode(wire);
  if (!telemetry) {
    return RejectUnattributed(channel, UnattributedReason::kMalformedId, telemetry.error().value);
  }
  VehicleWindow* const window = fleet_.Find(telemetry->vehicle_id);
  const auto partitions_of = [&reader](auto one) { return reader.PartitionsOf(one); };
  if (window == nullptr && fleet_.IsServedElsewhere(telemetry->vehicle_id)) return;
  if (window == nullptr) {
    RejectUnattributed(channel, UnattributedReason::kUnknownVehicle, telemetry->vehicle_id);
  } else if (!senders_.MaySend(writer, telemetry->vehicle_id, partitions_of)) {
    RejectUnattributed(channel, UnattributedReason::kForeignWriter, telemetry->vehicle_id);
  } else {
    TakeIn(*window, channel, *telemetry);
    CountReceived(*window);
  }
}

template <class Sample>
void Ingest::TakeIn(VehicleWindow& window, Channel channel, const Telemetry<Sample>& telemetry) {
  if (intake_.Admits(window, channel, Clock::now())) {
    window.Add(telemetry.sequence_number, telemetry.sample);
  } else {
    window.Shed(channel, telemetry.sequence_number, telemetry.sample.time_s);
  }
}

void Ingest::CountReceived(VehicleWindow& window) {
  std::size_t& since_receipt = since_receipt_[&window];
  if (++since_receipt < kSamplesPerReceipt) return;
  since_receipt = 0;
  handlers_.received(window);
}

void Ingest::RejectUnattributed(Channel channel, UnattributedReason reason,
                                std::string_view detail) {
  fleet_.CountUnattributed(Name(channel), reason);
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
