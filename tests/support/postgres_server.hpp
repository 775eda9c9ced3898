#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace telltale {

/// A real server of PostgreSQL for one test, reached by a socket in a folder of its own. It is gone
/// when the test is, however the test ends. Throws where PostgreSQL is not installed.
class PostgresServer {
 public:
  PostgresServer();  ///< makes a new cluster, and starts it
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;
  ~PostgresServer();

  std::string Address(const std::string& database = "postgres") const;

  /// Cuts every connection, as a server that crashes. What was committed is there after Start().
  void Stop();
  void Start();

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Process> process_;
};

/// The command of a program of PostgreSQL with these arguments, as a user that the server accepts:
/// it refuses root. The program ends with the process that has started it.
std::vector<std::string> PostgresCommand(const std::string& program,
                                         const std::vector<std::string>& arguments);

}  // namespace telltale
