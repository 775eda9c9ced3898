#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "support/postgres_server.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

enum class Engine { kSqlite, kPostgres };

inline const auto kEngines = ::testing::Values(Engine::kSqlite, Engine::kPostgres);

inline void PrintTo(Engine engine, std::ostream* out) {
  *out << (engine == Engine::kSqlite ? "SQLite" : "PostgreSQL");
}

/// The name of an engine in that of a test.
inline std::string EngineName(const ::testing::TestParamInfo<Engine>& info) {
  return ::testing::PrintToString(info.param);
}

/// A storage of one engine in a folder and on a server of the test's own.
class EngineStorage {
 public:
  explicit EngineStorage(Engine engine) {
    if (engine == Engine::kPostgres) server_.emplace();
  }

  telltale::Storage Storage() const { return StorageIn(folder_.Path()); }

  /// Where SQLite keeps its files in this folder.
  telltale::Storage StorageIn(const std::filesystem::path& folder) const {
    return telltale::Storage(folder, Address());
  }
  std::string Address() const { return server_ ? server_->Address() : ""; }  ///< of the server
  const TemporaryFolder& Folder() const { return folder_; }
  PostgresServer& Server() { return *server_; }

 private:
  TemporaryFolder folder_;
  std::optional<PostgresServer> server_;
};

/// A test that runs over both engines.
class StorageTest : public ::testing::TestWithParam<Engine> {
 protected:
  telltale::Storage Storage() const { return engine_.Storage(); }

  EngineStorage engine_{GetParam()};
};

}  // namespace telltale
