#include "support/postgres_server.hpp"

#include <pwd.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace telltale {
namespace {

/// Where Debian keeps the programs that are not on the path.
std::filesystem::path ProgramFolder() {
  const std::filesystem::path versions = "/usr/lib/postgresql";
  std::error_code none;
  for (const auto& version : std::filesystem::directory_iterator(versions, none)) {
    if (std::filesystem::exists(version.path() / "bin/postgres")) return version.path() / "bin";
  }
  throw std::runtime_error("there is no " + versions.string() +
                           "/*/bin/postgres: deploy/install-deps --tests");
}

}  // namespace

std::vector<std::string> PostgresCommand(const std::string& program,
                                         const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"/usr/bin/setpriv", "--pdeathsig", "KILL"};
  if (geteuid() == 0) {
    command.insert(command.end(), {"--reuid", "postgres", "--regid", "postgres", "--clear-groups"});
  }
  command.push_back(ProgramFolder() / program);
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

PostgresServer::PostgresServer() {
  if (geteuid() == 0) {
    const passwd* user = getpwnam("postgres");  // NOLINT(concurrency-mt-unsafe)
    if (user == nullptr) throw std::runtime_error("there is no user postgres");
    if (chown(folder_.Path().c_str(), user->pw_uid, user->pw_gid) != 0) {
      throw std::system_error(errno, std::generic_category(), folder_.Path());
    }
  }
  Process cluster(PostgresCommand(
      "initdb", {"--pgdata", folder_.Path() / "data", "--username", "telltale", "--auth", "trust",
                 "--encoding", "UTF8", "--no-locale", "--no-sync"}));
  if (cluster.Wait() != 0) throw std::runtime_error("initdb: " + cluster.output());
  Start();
}

PostgresServer::~PostgresServer() {
  Stop();
}

std::string PostgresServer::Address(const std::string& database) const {
  return "postgresql:///" + database + "?user=telltale&host=" + folder_.Path().string();
}

void PostgresServer::Stop() {
  if (!process_) return;
  process_->Signal(SIGQUIT);
  process_->Wait();
  process_.reset();
}

void PostgresServer::Start() {
  process_ = std::make_unique<Process>(PostgresCommand(
      "postgres", {"-D", folder_.Path() / "data", "-k", folder_.Path(), "-c", "listen_addresses=",
                   "-c", "log_min_messages=log", "-c", "log_checkpoints=off"}));
  if (!process_->WaitForOutput("ready to accept connections")) {
    throw std::runtime_error("postgres: " + process_->output());
  }
}

}  // namespace telltale
