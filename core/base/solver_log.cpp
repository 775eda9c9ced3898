#include "telltale/core/base/solver_log.hpp"

#include <glog/logging.h>

namespace telltale {

void SilenceSolverLog() {
  FLAGS_minloglevel = google::GLOG_FATAL;
}

}  // namespace telltale
