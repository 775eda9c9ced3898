#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace telltale {

/// The end of sd_notify(3) that a service manager holds, for programs that the test starts from now
/// on. With a watchdog of so long; zero: none.
class NotifySocket {
 public:
  NotifySocket(const std::filesystem::path& path, std::chrono::microseconds watchdog)
      : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::system_error(errno, std::generic_category(), path);
    }
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    if (watchdog.count() > 0) setenv("WATCHDOG_USEC", std::to_string(watchdog.count()).c_str(), 1);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;
  ~NotifySocket() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(socket_);
  }

  /// The next message; nothing where none has come by then.
  std::optional<std::string> Next(std::chrono::milliseconds timeout) {
    pollfd readable{socket_, POLLIN, 0};
    if (poll(&readable, 1, static_cast<int>(timeout.count())) != 1) return std::nullopt;
    std::array<char, 4096> message;
    const ssize_t length = recv(socket_, message.data(), message.size(), 0);
    return std::string(message.data(), static_cast<std::size_t>(std::max<ssize_t>(0, length)));
  }

  /// All messages up to the first that begins so; false where a minute passes without one.
  bool Await(const std::string& beginning, std::string* before = nullptr) {
    while (const auto message = Next(std::chrono::minutes(1))) {
      if (message->starts_with(beginning)) return true;
      if (before != nullptr) *before += *message + "\n";
    }
    return false;
  }

 private:
  int socket_;
};

}  // namespace telltale
