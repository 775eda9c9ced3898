#include "telltale/service/storage/store_status.hpp"

namespace telltale {

bool StoreStatus::NoteOpening(const std::string& database) {
  const std::lock_guard lock(mutex_);
  return opened_.insert(database).second;
}

void StoreStatus::NoteSuccess(const std::string& database) {
  const std::lock_guard lock(mutex_);
  faults_.erase(database);
  unavailable_.reset();
}

void StoreStatus::NoteFault(const std::string& database, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  faults_.insert_or_assign(database, reason);
}

void StoreStatus::NoteUnavailable(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  unavailable_ = reason;
}

std::optional<std::string> StoreStatus::Unavailable() const {
  const std::lock_guard lock(mutex_);
  return unavailable_;
}

std::optional<std::string> StoreStatus::Fault() const {
  const std::lock_guard lock(mutex_);
  if (unavailable_) return unavailable_;
  if (faults_.empty()) return std::nullopt;
  return faults_.begin()->second;
}

}  // namespace telltale
