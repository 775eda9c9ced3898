#include "telltale/client/cli/library_logs.hpp"

#include <memory>

#include <spdlog/sinks/stdout_sinks.h>

#include "telltale/core/base/solver_log.hpp"
#include "telltale/idl/codec/protobuf_log.hpp"

namespace telltale {
namespace {

std::shared_ptr<spdlog::logger> ErrorsOnly() {
  auto logger =
      std::make_shared<spdlog::logger>("dds", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("telltale: %v");
  logger->set_level(spdlog::level::err);
  return logger;
}

}  // namespace

LibraryLogs::LibraryLogs() : bus_log_(ErrorsOnly()) {
  SilenceSolverLog();
  SilenceProtobufLog();
}

}  // namespace telltale
