#include "telltale/service/registry/announcements.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <utility>

#include <pthread.h>

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "telltale/idl/codec/wire/vehicle_announcement.hpp"

namespace telltale {
namespace {

constexpr auto kPeriod = std::chrono::seconds(1);

// To serve boats anew takes time for each boat of the fleet: those that come together join
// together.
constexpr auto kGatherTime = std::chrono::milliseconds(100);

constexpr std::string_view kTooManyIds = "TOO_MANY_IDS";

constexpr std::size_t kMostNamed = 8;

void Tell(const char* what, const std::vector<std::string>& vehicle_ids) {
  if (vehicle_ids.empty()) return;
  const std::size_t named = std::min(vehicle_ids.size(), kMostNamed);
  const std::size_t others = vehicle_ids.size() - named;
  spdlog::info("{} vehicles {}: {}{}", vehicle_ids.size(), what,
               fmt::join(vehicle_ids.begin(), vehicle_ids.begin() + static_cast<long>(named), ", "),
               others > 0 ? fmt::format(" and {} more", others) : "");
}

}  // namespace

Announcements::LimitedReader::LimitedReader(const Participant& participant)
    : lifetime(kMostBoats, std::chrono::steady_clock::now()),
      limit(kMostBoats),
      reader(participant, limit) {}

Announcements::Announcements(const Participant& participant, Fleet& fleet, bool require_partition,
                             Handlers handlers)
    : fleet_(fleet),
      participant_(participant),
      handlers_(std::move(handlers)),
      senders_(require_partition),
      warning_limit_(5, std::chrono::seconds(10)),
      wait_set_(participant),
      thread_([this] { Run(); }) {}

Announcements::~Announcements() {
  stopping_ = true;
  wait_set_.Wake();
  thread_.join();
}

void Announcements::HearAgain() {
  hear_again_ = true;
  wait_set_.Wake();
}

void Announcements::Run() {
  pthread_setname_np(pthread_self(), "announcements");
  while (!stopping_) {
    try {
      if (hear_again_.exchange(false)) Listen();
      const bool heard = wait_set_.Wait(kPeriod);
      CountUnheard();
      Settle();
      if (heard) std::this_thread::sleep_for(kGatherTime);
    } catch (const std::exception& error) {
      if (const auto not_shown = warning_limit_.Admit(std::chrono::steady_clock::now())) {
        spdlog::error("announced vehicles: {} ({} more not shown)", error.what(), *not_shown);
      }
    }
  }
}

void Announcements::Settle() {
  const bool changed = !admitted_.empty() || !altered_.empty() || !retired_.empty();
  Tell("announced themselves and are admitted", std::exchange(admitted_, {}));
  Tell("announced other particulars", std::exchange(altered_, {}));
  Tell("are retired", std::exchange(retired_, {}));
  handlers_.settle(changed);
}

/// A new reader is given all that is on the bus. DDS Security may deny it: then the daemon does its
/// work without.
void Announcements::Listen() {
  if (heard_) {
    TakeAll();
    wait_set_.Detach(heard_->reader);
  }
  heard_.emplace(participant_);
  wait_set_.Attach(heard_->reader, [this] { TakeAll(); });
}

void Announcements::CountUnheard() {
  if (!heard_) return;
  if (const std::uint64_t refused = heard_->limit.TakeRefused(); refused > 0) {
    Refuse(kTooManyIds, std::to_string(kMostBoats) + " ids have been heard", refused);
    heard_->lifetime.NoteFull();
  }
  if (heard_->lifetime.IsOver(std::chrono::steady_clock::now())) hear_again_ = true;
}

void Announcements::TakeAll() {
  heard_->reader.TakeOrDispose([this](const auto& wire, auto writer) { Take(wire, writer); },
                               [this](const auto& wire, auto writer) { Retire(wire, writer); });
}

void Announcements::Take(const telltale_wire_VehicleAnnouncement& wire, WriterHandle writer) {
  const auto vehicle = Decode(wire);
  if (!vehicle) return Refuse(Name(vehicle.error().reason), vehicle.error().Message());
  if (MaySend(writer, vehicle->vehicle_id)) {
    Note(handlers_.announced(*vehicle), vehicle->vehicle_id);
  }
}

void Announcements::Retire(const telltale_wire_VehicleAnnouncement& wire, WriterHandle writer) {
  const auto id = AnnouncedId(wire);
  if (!id) return Refuse(Name(AnnouncementFaultReason::kMalformedId), id.error().Message());
  if (!MaySend(writer, *id)) return;
  if (handlers_.retired(*id)) {
    retired_.push_back(*id);
  } else {
    heard_->lifetime.NoteUnknownRetired();
  }
}

bool Announcements::MaySend(WriterHandle writer, const std::string& vehicle_id) {
  const auto partitions_of = [this](auto one) { return heard_->reader.PartitionsOf(one); };
  if (senders_.MaySend(writer, vehicle_id, partitions_of)) return true;
  Refuse(Name(UnattributedReason::kForeignWriter), vehicle_id);
  return false;
}

void Announcements::Note(Admission admission, const std::string& vehicle_id) {
  switch (admission) {
    case Admission::kKnown: return;
    case Admission::kAdmitted: return admitted_.push_back(vehicle_id);
    case Admission::kChanged: return altered_.push_back(vehicle_id);
    case Admission::kConfigured:
      if (!told_.insert(vehicle_id).second) return;
      return spdlog::info("{} announces itself; what the configuration says of it holds",
                          vehicle_id);
    default: Refuse(Name(admission), vehicle_id);
  }
}

void Announcements::Refuse(std::string_view reason, const std::string& detail,
                           std::uint64_t count) {
  fleet_.CountUnattributed(kAnnouncements, reason, count);
  if (const auto not_shown = warning_limit_.Admit(std::chrono::steady_clock::now())) {
    spdlog::warn("announcement refused: {} '{}' ({} more not shown)", reason, detail, *not_shown);
  }
}

}  // namespace telltale
