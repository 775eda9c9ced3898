#pragma once

#include <sys/ptrace.h>
#include <sys/wait.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace telltale {

/// A thread of a program that this test has started: it stands still while this object lives, and
/// the others go on. Of the thread that makes it.
class FrozenThread {
 public:
  FrozenThread(pid_t program, const std::string& name) : thread_(ThreadNamed(program, name)) {
    const bool stops = ptrace(PTRACE_SEIZE, thread_, nullptr, nullptr) == 0 &&
                       ptrace(PTRACE_INTERRUPT, thread_, nullptr, nullptr) == 0;
    if (!stops) throw std::system_error(errno, std::generic_category(), "ptrace");
    waitpid(thread_, nullptr, __WALL);
  }
  FrozenThread(const FrozenThread&) = delete;
  FrozenThread& operator=(const FrozenThread&) = delete;
  ~FrozenThread() { ptrace(PTRACE_DETACH, thread_, nullptr, nullptr); }

 private:
  static pid_t ThreadNamed(pid_t program, const std::string& name) {
    const std::filesystem::path tasks = "/proc/" + std::to_string(program) + "/task";
    for (const auto& task : std::filesystem::directory_iterator(tasks)) {
      std::string line;
      std::getline(std::ifstream(task.path() / "comm"), line);
      if (line == name) return std::stoi(task.path().filename());
    }
    throw std::runtime_error("no thread is named " + name);
  }

  const pid_t thread_;
};

}  // namespace telltale
