#include "support/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
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

Process::Process(const std::vector<std::string>& command, Output output) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
  if (output == Output::kUnread) fcntl(ends[0], F_SETPIPE_SZ, 1);  // a page is the least
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
  leave_ = eventfd(0, EFD_CLOEXEC);
  if (output == Output::kUnread) {
    ended_ = true;
    return;
  }
  gathering_ = std::thread([this] { Gather(); });
}

Process::~Process() {
  if (!reaped_) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  eventfd_write(leave_, 1);
  if (gathering_.joinable()) gathering_.join();
  close(leave_);
  close(pipe_);
}

void Process::Gather() {
  while (TakeIn()) {
  }
  const std::lock_guard lock(mutex_);
  ended_ = true;
  came_.notify_all();
}

bool Process::TakeIn() {
  constexpr int kForEver = -1;
  std::array<pollfd, 2> readable{{{pipe_, POLLIN, 0}, {leave_, POLLIN, 0}}};
  if (poll(readable.data(), readable.size(), kForEver) < 0) return errno == EINTR;
  if (readable[1].revents != 0) return false;
  std::array<char, 4096> buffer;
  const auto count = read(pipe_, buffer.data(), buffer.size());
  if (count <= 0) return false;
  const std::lock_guard lock(mutex_);
  output_.append(buffer.data(), static_cast<std::size_t>(count));
  came_.notify_all();
  return true;
}

std::string Process::output() const {
  const std::lock_guard lock(mutex_);
  return output_;
}

bool Process::WaitForOutput(std::string_view text, std::chrono::seconds timeout) {
  const auto has_come = [&] { return output_.find(text) != std::string::npos; };
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, timeout, [&] { return ended_ || has_come(); });
  return has_come();
}

std::optional<int> Process::Wait(std::chrono::seconds timeout) {
  const auto deadline = Clock::now() + timeout;
  {
    std::unique_lock lock(mutex_);
    came_.wait_until(lock, deadline, [this] { return ended_; });
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
