#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

namespace telltale {

/// Whether what comes can be saved now. Thread safe.
class StoreStatus {
 public:
  /// Whether it is the first opening of this database.
  bool NoteOpening(const std::string& database);

  void NoteSuccess(const std::string& database);
  void NoteFault(const std::string& database, const std::string& reason);
  void NoteUnavailable(const std::string& reason);

  /// Why the database cannot be reached; nothing where the last try reached it.
  std::optional<std::string> Unavailable() const;

  /// Why something is not saved, Unavailable() or another fault; nothing where all is well.
  std::optional<std::string> Fault() const;

 private:
  mutable std::mutex mutex_;                   // of what follows
  std::set<std::string> opened_;               ///< databases
  std::map<std::string, std::string> faults_;  ///< by database
  std::optional<std::string> unavailable_;
};

}  // namespace telltale
