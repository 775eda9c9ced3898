#include "telltale/service/jobs/urgency.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace telltale {

void YieldToMoreUrgentThan(Urgency urgency) {
  constexpr int kRefreshNice = 10;
  constexpr int kBackgroundNice = 19;
  if (urgency == Urgency::kInteractive) return;
  // Linux keeps the nice value of each thread by itself, under the number of the thread. It may be
  // refused where it is limited, and all then share the processors alike.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()),
              urgency == Urgency::kRefresh ? kRefreshNice : kBackgroundNice);
}

}  // namespace telltale
