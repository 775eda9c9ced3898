#include "telltale/service/role.hpp"

namespace telltale {

void Role::Assume(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  Prolong(now);
}

void Role::Renew(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (now < ends_) Prolong(now);
}

void Role::Resign() {
  const std::lock_guard lock(mutex_);
  ends_ = Clock::time_point::min();
}

bool Role::Serves(Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  return now < ends_;
}

}  // namespace telltale
