#include "telltale/service/jobs/urgency.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace telltale {

void YieldToMoreUrgentThan(Urgency urgency) {
  constexpr int kRefreshSteps = 10;
  constexpr int kBackgroundSteps = 19;
  if (urgency == Urgency::kInteractive) return;
  // Linux keeps the nice value of each thread by itself, under the number of the thread, and takes
  // the largest there is for all that are larger. The shares of two threads follow from the
  // difference of their values, so these are steps from the daemon's own.
  const auto thread = static_cast<id_t>(gettid());
  const int steps = urgency == Urgency::kRefresh ? kRefreshSteps : kBackgroundSteps;
  setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + steps);
}

}  // namespace telltale
