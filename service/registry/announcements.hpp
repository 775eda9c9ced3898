#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "telltale/client/bus/bus_log.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/service/ingest/fleet.hpp"
#include "telltale/service/ingest/senders.hpp"
#include "telltale/service/registry/reader_lifetime.hpp"
#include "telltale/service/registry/vehicle_registry.hpp"

namespace telltale {

/// Hears the boats that announce themselves, on a thread of its own. What is refused is counted
/// among the samples that name no vehicle, as those of the channel "vehicle", and logged with a
/// limit. Of more than kMostBoats ids it hears no further ones until it hears all anew, by
/// ReaderLifetime, and counts what it does not hear. Where the bus denies the topic, the log says
/// so and no boat is heard.
class Announcements {
 public:
  /// All are called on the thread.
  struct Handlers {
    std::function<Admission(const Vehicle& vehicle)> announced;
    std::function<bool(const std::string& vehicle_id)> retired;  ///< whether it was announced
    /// Once a second at least, and after what has just been heard; `changed` where that changes the
    /// fleet. What it throws is logged.
    std::function<void(bool changed)> settle;
  };

  /// `require_partition`: as Senders.
  Announcements(const Participant& participant, Fleet& fleet, bool require_partition,
                Handlers handlers);
  Announcements(const Announcements&) = delete;
  Announcements& operator=(const Announcements&) = delete;
  ~Announcements();  ///< ends the thread

  /// Hears every boat again that is on the bus. Any thread may call it.
  void HearAgain();

 private:
  void Run();
  void Listen();
  void CountUnheard();
  void TakeAll();
  void Take(const telltale_wire_VehicleAnnouncement& wire, WriterHandle writer);
  void Retire(const telltale_wire_VehicleAnnouncement& wire, WriterHandle writer);
  bool MaySend(WriterHandle writer, const std::string& vehicle_id);
  void Settle();
  void Note(Admission admission, const std::string& vehicle_id);
  void Refuse(std::string_view reason, const std::string& detail, std::uint64_t count = 1);

  Fleet& fleet_;
  const Participant& participant_;
  const Handlers handlers_;
  Senders senders_;
  RateLimit warning_limit_;
  std::set<std::string> told_;         ///< boats of the configuration that announce themselves
  std::vector<std::string> admitted_;  ///< since the fleet was settled, as the next two
  std::vector<std::string> altered_;
  std::vector<std::string> retired_;
  WaitSet wait_set_;  // before the reader attached to it, so that it goes last
  /// A reader with the limit of its ids, which it needs for as long as it lives.
  struct LimitedReader {
    explicit LimitedReader(const Participant& participant);

    ReaderLifetime lifetime;
    InstanceLimit limit;
    Reader<telltale_wire_VehicleAnnouncement> reader;
  };
  std::optional<LimitedReader> heard_;
  std::atomic<bool> hear_again_ = true;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace telltale
