#include <atomic>
#include <cerrno>
#include <csignal>
#include <string>

#include <semaphore.h>
#include <unistd.h>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "telltale/core/base/solver_log.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/idl/codec/protobuf_log.hpp"
#include "telltale/service/configuration.hpp"
#include "telltale/service/daemon.hpp"

namespace telltale {
namespace {

constexpr int kFailure = 1;
constexpr int kUsageError = 2;

sem_t stop_requested;

/// Waits for SIGINT or SIGTERM in any thread. Libraries start threads before main that block
/// neither signal, so blocking the signals here and waiting for them would let them kill the
/// process.
class StopSignals {
 public:
  StopSignals() {
    sem_init(&stop_requested, 0, 0);
    struct sigaction action {};
    action.sa_handler = [](int) { sem_post(&stop_requested); };
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  }

  void Wait() const {
    while (sem_wait(&stop_requested) != 0 && errno == EINTR) {
    }
  }
};

int Serve(const DaemonConfig& config, const StopSignals& signals) {
  std::atomic<bool> receiving = true;
  const Daemon daemon(config, [&](const std::exception& error) {
    spdlog::critical("cannot receive telemetry any more: {}", error.what());
    receiving = false;
    kill(getpid(), SIGTERM);
  });
  spdlog::info("serving {} vehicles on domain {}, models are stored in {}", config.vehicles.size(),
               config.domain, config.state_directory);
  signals.Wait();
  spdlog::info("stopping");
  return receiving ? 0 : kFailure;
}

int Main(int argc, char** argv) {
  SilenceSolverLog();
  SilenceProtobufLog();
  CLI::App app{"Identifies a fleet's vehicles from their telemetry over DDS.", "telltaled"};
  std::string config_file;
  app.add_option("--config", config_file, "configuration, Protobuf text format")->required();
  app.set_version_flag("--version", "telltaled " + std::string(Version()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageError;
  }

  spdlog::set_default_logger(spdlog::stderr_color_mt("telltaled"));
  const auto config = LoadConfiguration(config_file);
  if (!config) {
    spdlog::critical("{}", config.error().Message());
    return kUsageError;
  }
  spdlog::set_level(spdlog::level::from_str(config->log_level));
  const StopSignals signals;
  try {
    return Serve(*config, signals);
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
    return kFailure;
  }
}

}  // namespace
}  // namespace telltale

int main(int argc, char** argv) {
  return telltale::Main(argc, argv);
}
