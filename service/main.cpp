#include <stdexcept>
#include <string>
#include <vector>

#include <malloc.h>

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "telltale/core/base/solver_log.hpp"
#include "telltale/core/base/version.hpp"
#include "telltale/idl/codec/protobuf_log.hpp"
#include "telltale/service/configuration.hpp"
#include "telltale/service/monitoring/daemon_log.hpp"
#include "telltale/service/serving.hpp"
#include "telltale/service/storage/backup.hpp"

namespace telltale {
namespace {

constexpr int kFailure = 1;
constexpr int kUsageError = 2;

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
  auto& instead = *app.add_option_group("instead", "of serving vehicles")->require_option(0, 1);
  instead
      .add_option("--backup", backup,
                  "copy the databases of the state directory into this folder, also while another "
                  "telltaled uses them, and end")
      ->type_name("DIR");
  instead
      .add_option("--restore", restore,
                  "put the databases of a backup in the place of those of the state directory, "
                  "which are set aside, and end")
      ->type_name("DIR");
  bool works = false;
  instead.add_flag("--worker", works,
                   "compute coverage checks and diagnoses for the daemons that name the same "
                   "database and have workers {}");
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
  try {
    if (!backup.empty() || !restore.empty()) RequireFiles(*config);
    if (!backup.empty()) {
      return Report("backed up to " + backup, BackUp(config->state_directory, backup));
    }
    if (!restore.empty()) {
      return Report("restored from " + restore, RestoreBackup(restore, config->state_directory));
    }
    if (!works) return Serve(*config, config_file) ? 0 : kFailure;
    if (const auto refused = ServeAsWorker(*config, config_file)) {
      spdlog::critical("{}", refused->Message());
      return kUsageError;
    }
    return 0;
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
