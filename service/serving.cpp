#include "telltale/service/serving.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <utility>

#include <semaphore.h>
#include <unistd.h>

#include <spdlog/spdlog.h>

#include "telltale/service/configuration.hpp"
#include "telltale/service/daemon.hpp"
#include "telltale/service/supervision/service_manager.hpp"
#include "telltale/service/workers/worker.hpp"

namespace telltale {
namespace {

sem_t signalled;
std::atomic<bool> stop_requested = false;
std::atomic<bool> replaced = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// What the main thread waits for.
enum class Event { kReload, kReplaced, kStop };

/// Waits for SIGINT, SIGTERM or SIGHUP in any thread, or for the daemon to be replaced. Libraries
/// start threads before main that block no signal, so blocking the signals here and waiting for
/// them would let them kill the process.
class Signals {
 public:
  Signals() {
    sem_init(&signalled, 0, 0);
    struct sigaction action {};
    action.sa_handler = [](int signal) {
      if (signal != SIGHUP) stop_requested = true;
      sem_post(&signalled);
    };
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  }

  Event Wait() const {
    while (sem_wait(&signalled) != 0 && errno == EINTR) {
    }
    if (stop_requested) return Event::kStop;
    return replaced.exchange(false) ? Event::kReplaced : Event::kReload;
  }
};

/// A wrong configuration changes nothing.
void ReloadVehicles(Daemon& daemon, const std::string& config_file) {
  const auto config = LoadConfiguration(config_file);
  if (!config) {
    return spdlog::error("the vehicles are not reloaded: {}", config.error().Message());
  }
  try {
    daemon.Reload(*config);
  } catch (const DatabaseError& error) {
    spdlog::error("the vehicles are reloaded, and not all of their models: {}", error.what());
  }
}

void Reload(Daemon& daemon, const std::string& config_file) {
  ServiceManager::TellReloading();
  ReloadVehicles(daemon, config_file);
  ServiceManager::TellReady();
}

/// Until the daemon is to stop, or is replaced by another.
Event ServeOnce(const DaemonConfig& config, const std::string& config_file, const Signals& signals,
                std::atomic<bool>& receiving) {
  Daemon daemon(config, {.failed =
                             [&](const std::exception& error) {
                               spdlog::critical("cannot receive telemetry any more: {}",
                                                error.what());
                               receiving = false;
                               kill(getpid(), SIGTERM);
                             },
                         .replaced =
                             [] {
                               replaced = true;
                               sem_post(&signalled);
                             }});
  spdlog::info("serving {} vehicles on domain {}, models are stored in {}", daemon.FleetSize(),
               config.domain, config.database.empty() ? config.state_directory : "PostgreSQL");
  for (;;) {
    const Event event = signals.Wait();
    if (event == Event::kStop) ServiceManager::TellStopping();
    if (event != Event::kReload) return event;
    Reload(daemon, config_file);
  }
}

}  // namespace

bool Serve(DaemonConfig config, const std::string& config_file) {
  const Signals signals;
  std::atomic<bool> receiving = true;
  while (ServeOnce(config, config_file, signals, receiving) == Event::kReplaced) {
    spdlog::warn("another daemon serves; this one starts again as its standby");
    if (const auto reloaded = LoadConfiguration(config_file)) {
      config.vehicles = reloaded->vehicles;
      config.announced = reloaded->announced;
    }
  }
  spdlog::info("stopping");
  return receiving;
}

std::optional<CodecError> ServeAsWorker(const DaemonConfig& config,
                                        const std::string& config_file) {
  if (!config.workers) {
    return CodecError{"workers", "not given", "this with database, which the daemons name too",
                      config_file};
  }
  const Signals signals;
  const Worker worker(config);
  ServiceManager::TellReady();
  spdlog::info("waiting for jobs");
  while (signals.Wait() != Event::kStop) {
  }
  ServiceManager::TellStopping();
  spdlog::info("stopping");
  return std::nullopt;
}

}  // namespace telltale
