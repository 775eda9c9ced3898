#include <atomic>
#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

#include <malloc.h>
#include <semaphore.h>
#include <unistd.h>

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "telltale/core/base/solver_log.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/idl/codec/protobuf_log.hpp"
#include "telltale/service/configuration.hpp"
#include "telltale/service/daemon.hpp"
#include "telltale/service/monitoring/daemon_log.hpp"
#include "telltale/service/storage/backup.hpp"
#include "telltale/service/supervision/service_manager.hpp"
#include "telltale/service/workers/worker.hpp"

namespace telltale {
namespace {

constexpr int kFailure = 1;
constexpr int kUsageError = 2;

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

/// Of SQLite: PostgreSQL has programs of its own for this.
void RequireFiles(const DaemonConfig& config) {
  if (config.database.empty()) return;
  throw std::runtime_error(
      "--backup and --restore copy the files of state_directory, and the configuration names a "
      "database: use pg_dump and pg_restore");
}

int Report(const std::string& what, const std::vector<std::string>& files) {
  std::string names;
  for (const std::string& file : files) names += (names.empty() ? "" : ", ") + file;
  spdlog::info("{}: {}", what, names);
  return 0;
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

int Serve(DaemonConfig config, const std::string& config_file, const Signals& signals) {
  std::atomic<bool> receiving = true;
  while (ServeOnce(config, config_file, signals, receiving) == Event::kReplaced) {
    spdlog::warn("another daemon serves; this one starts again as its standby");
    if (const auto reloaded = LoadConfiguration(config_file)) {
      config.vehicles = reloaded->vehicles;
      config.announced = reloaded->announced;
    }
  }
  spdlog::info("stopping");
  return receiving ? 0 : kFailure;
}

int ServeAsWorker(const DaemonConfig& config, const std::string& config_file,
                  const Signals& signals) {
  if (!config.workers) {
    spdlog::critical("{}", CodecError{"workers", "not given",
                                      "this with database, which the daemons name too", config_file}
                               .Message());
    return kUsageError;
  }
  const Worker worker(config);
  ServiceManager::TellReady();
  spdlog::info("waiting for jobs");
  while (signals.Wait() != Event::kStop) {
  }
  ServiceManager::TellStopping();
  spdlog::info("stopping");
  return 0;
}

/// glibc lets threads beyond eight a processor share their heaps. One that computes and gets no
/// processor could then hold the heap of one that must not wait.
void GiveEachThreadAHeap() {
  constexpr int kMoreThanThreads = 1024;
  mallopt(M_ARENA_MAX, kMoreThanThreads);  // NOLINT(concurrency-mt-unsafe): no thread runs yet
}

int Main(int argc, char** argv) {
  GiveEachThreadAHeap();
  SilenceSolverLog();
  SilenceProtobufLog();
  CLI::App app{"Identifies a fleet's vehicles from their telemetry over DDS.", "telltaled"};
  std::string config_file;
  app.add_option("--config", config_file, "configuration, Protobuf text format")->required();
  std::string backup;
  std::string restore;
  auto* const back_up =
      app.add_option("--backup", backup,
                     "copy the databases of the state directory into this folder, also while "
                     "another telltaled uses them, and end")
          ->type_name("DIR");
  app.add_option("--restore", restore,
                 "put the databases of a backup in the place of those of the state directory, "
                 "which are set aside, and end")
      ->type_name("DIR")
      ->excludes(back_up);
  bool works = false;
  app.add_flag("--worker", works,
               "compute coverage checks and diagnoses for the daemons that name the same database "
               "and have workers {}, and serve no vehicle")
      ->excludes("--backup")
      ->excludes("--restore");
  app.footer("SIGHUP reloads the vehicles; SIGTERM and SIGINT stop the daemon.");
  app.set_version_flag("--version", "telltaled " + std::string(Version()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageError;
  }

  const DaemonLog log;
  const auto config = LoadConfiguration(config_file);
  if (!config) {
    spdlog::critical("{}", config.error().Message());
    return kUsageError;
  }
  spdlog::set_level(spdlog::level::from_str(config->log_level));
  const Signals signals;
  try {
    if (!backup.empty() || !restore.empty()) RequireFiles(*config);
    if (!backup.empty()) {
      return Report("backed up to " + backup, BackUp(config->state_directory, backup));
    }
    if (!restore.empty()) {
      return Report("restored from " + restore, RestoreBackup(restore, config->state_directory));
    }
    if (works) return ServeAsWorker(*config, config_file, signals);
    return Serve(*config, config_file, signals);
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
