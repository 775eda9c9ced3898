#include "support/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <system_error>

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

int MillisecondsUntil(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  return std::max(0, static_cast<int>(left.count()));
}

/// Waits for the end of a child without reaping it.
bool Ends(pid_t pid, Clock::time_point deadline) {
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
  pollfd ended{handle, POLLIN, 0};
  const bool ends = poll(&ended, 1, MillisecondsUntil(deadline)) == 1;
  close(handle);
  return ends;
}

}  // namespace

Process::Process(const std::vector<std::string>& command) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  const int error = posix_spawn(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  pipe_ = ends[0];
  if (error != 0) throw std::system_error(error, std::generic_category(), command.front());
}

Process::~Process() {
  close(pipe_);
  if (reaped_) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool Process::ReadUntil(Clock::time_point deadline) {
  pollfd readable{pipe_, POLLIN, 0};
  if (poll(&readable, 1, MillisecondsUntil(deadline)) != 1) return false;
  std::array<char, 4096> buffer;
  const auto count = read(pipe_, buffer.data(), buffer.size());
  if (count <= 0) return false;
  output_.append(buffer.data(), static_cast<std::size_t>(count));
  return true;
}

bool Process::WaitForOutput(std::string_view text, std::chrono::seconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (output_.find(text) == std::string::npos) {
    if (!ReadUntil(deadline)) return false;
  }
  return true;
}

std::optional<int> Process::Wait(std::chrono::seconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (ReadUntil(deadline)) {
  }
  if (!Ends(pid_, deadline)) return std::nullopt;
  int status = 0;
  waitpid(pid_, &status, 0);
  reaped_ = true;
  return WIFEXITED(status) ? std::optional(WEXITSTATUS(status)) : std::nullopt;
}

void Process::Signal(int signal) const {
  kill(pid_, signal);
}

void Process::Suspend() const {
  Signal(SIGSTOP);
  waitpid(pid_, nullptr, WUNTRACED);
}

void Process::Resume() const {
  Signal(SIGCONT);
}

}  // namespace telltale
