#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "telltale/idl/codec/daemon_config.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

enum class RemovedKind { kEarlierModel, kEarlierDiagnosis, kWindowChunk };
enum class RemovalReason { kCount, kAge, kSize };

std::string_view Name(RemovedKind kind);      ///< "model", "diagnosis", "window_chunk"
std::string_view Name(RemovalReason reason);  ///< "count", "age", "size"

/// How many rows.
using RemovalCounts = std::map<std::pair<RemovedKind, RemovalReason>, std::uint64_t>;

/// What a pass has removed, and what the store takes after it.
struct RetentionPass {
  RemovalCounts removed;
  std::map<std::string, std::int64_t> used_bytes;  ///< by store: models, windows, requests
  bool over_limit = false;                         ///< and nothing more may go

  std::int64_t UsedBytes() const;  ///< of all stores
};

/// Removes from the storage what is beyond the limits, in transactions of at most 64 rows, and
/// gives free space back to the disk.
///
/// By number go models; by age go models, diagnoses before the last, and saved windows. Where the
/// store takes more than its limit, these go until it does not, oldest first: windows of vehicles
/// that are no longer in the fleet, then diagnoses before the last, then models.
///
/// Never removed: the newest model of a vehicle, the model that it publishes again after a
/// rollback, the newest model before it whose verdict is neither WARN nor ERROR, the last
/// diagnosis, unanswered requests, and windows that a program without retention has saved, as their
/// age is not known. With leases it removes of the vehicles whose slice this daemon holds.
///
/// Throws DatabaseError where the database refuses. Not thread safe.
class StoreRetention {
 public:
  using IsInFleet = std::function<bool(const std::string& vehicle_id)>;

  StoreRetention(const Storage& storage, const RetentionSettings& settings, IsInFleet is_in_fleet);

  RetentionPass Apply(double now_unix_s);

  const RetentionSettings& settings() const { return settings_; }

 private:
  /// What rows of one kind are called by.
  struct Target {
    RemovedKind kind;
    Database& database;
    std::string table;
    std::string place;   ///< the second column of its key, after vehicle_id
    std::string time;    ///< the column with the time since which it is kept, UNIX seconds
    std::string may_go;  ///< a condition on a row m
  };

  /// A row that may go, by its key.
  struct Candidate {
    std::string vehicle_id;
    std::variant<std::int64_t, double> place;
  };
  using Candidates = std::vector<Candidate>;

  Target Models() const;
  Target Diagnoses() const;
  Target Windows() const;
  Candidates Find(const Target& target, const std::string& condition,
                  const Parameters& parameters) const;
  Candidates FindOfFormerVehicles(const Target& target) const;
  std::size_t Remove(const Target& target, std::span<const Candidate> candidates);
  void RemoveAll(const Target& target, RemovalReason reason, const std::string& condition,
                 const Parameters& parameters, RetentionPass& pass);
  void RemoveOlder(const Target& target, double age_s, double now_unix_s, RetentionPass& pass);
  void RemoveBeyondSize(RetentionPass& pass);
  std::size_t RemoveUntilItFits(const Target& target, const Candidates& candidates,
                                RetentionPass& pass);
  bool Fits(const RetentionPass& pass) const;
  void GiveBackSpace();
  void Measure(RetentionPass& pass) const;

  const Storage storage_;
  const RetentionSettings settings_;
  const IsInFleet is_in_fleet_;
  std::unique_ptr<Database> models_;
  std::unique_ptr<Database> windows_;
  std::unique_ptr<Database> requests_;
};

}  // namespace telltale
