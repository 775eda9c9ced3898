#include "telltale/service/storage/backup.hpp"

#include <array>
#include <stdexcept>

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>

#include "telltale/client/fleet/unix_now.hpp"
#include "telltale/service/storage/directory_lock.hpp"

namespace telltale {
namespace {

constexpr std::array kStateDatabases = {"models.sqlite", "windows.sqlite", "requests.sqlite",
                                        "vehicles.sqlite", "terms.sqlite"};
constexpr int kBusyMs = 10000;

/// The databases of this folder. Throws where there is none.
std::vector<std::string> DatabasesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const char* name : kStateDatabases) {
    if (std::filesystem::exists(folder / name)) names.emplace_back(name);
  }
  if (names.empty()) {
    throw std::runtime_error(folder.string() + " holds no database of a daemon");
  }
  return names;
}

void Copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  SQLite::Database source(from, SQLite::OPEN_READWRITE, kBusyMs);
  SQLite::Database target(to, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyMs);
  SQLite::Backup(target, source).executeStep();
  target.exec("PRAGMA journal_mode = DELETE");  // one file, which a daemon turns to WAL again
}

void RequireWhole(const std::filesystem::path& file) {
  SQLite::Database database(file, SQLite::OPEN_READONLY);
  const std::string found = database.execAndGet("PRAGMA integrity_check(1)").getString();
  if (found != "ok") throw std::runtime_error(file.string() + " is damaged: " + found);
}

void ReplaceFile(const std::filesystem::path& file, const std::string& suffix) {
  for (const char* part : {"-wal", "-shm", ""}) {
    const std::filesystem::path present = file.string() + part;
    if (std::filesystem::exists(present)) {
      std::filesystem::rename(present, file.string() + suffix + part);
    }
  }
}

}  // namespace

std::vector<std::string> BackUp(const std::filesystem::path& state_directory,
                                const std::filesystem::path& to) {
  auto names = DatabasesIn(state_directory);
  std::filesystem::create_directories(to);
  for (const std::string& name : names) {
    if (std::filesystem::exists(to / name)) {
      throw std::runtime_error((to / name).string() + " is there already: name another folder");
    }
  }
  for (const std::string& name : names) {
    Copy(state_directory / name, to / name);
    RequireWhole(to / name);
  }
  return names;
}

std::vector<std::string> RestoreBackup(const std::filesystem::path& from,
                                       const std::filesystem::path& state_directory) {
  auto names = DatabasesIn(from);
  for (const std::string& name : names) RequireWhole(from / name);
  const DirectoryLock lock(state_directory);
  const std::string suffix = ".replaced-" + std::to_string(static_cast<long>(UnixNow()));
  for (const char* name : kStateDatabases) ReplaceFile(state_directory / name, suffix);
  for (const std::string& name : names) Copy(from / name, state_directory / name);
  return names;
}

}  // namespace telltale
