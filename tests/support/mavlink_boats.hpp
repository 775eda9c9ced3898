#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace telltale {

/// A port of this machine that nobody listens on; of SOCK_DGRAM or SOCK_STREAM.
inline int FreePort(int kind) {
  const int socket_handle = socket(AF_INET, kind, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  bind(socket_handle, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(socket_handle, reinterpret_cast<sockaddr*>(&address), &size);
  close(socket_handle);
  return ntohs(address.sin_port);
}

/// Autopilots by node-mavlink: systems 1 and 2 of send_live.mjs. Requires the definitions
/// TELLTALE_SOURCE_DIR and TELLTALE_BINARY_DIR.
class MavlinkBoats {
 public:
  /// Installs what they need; why they cannot run, where the registry of npm cannot be reached.
  /// Throws where it fails otherwise.
  static std::optional<std::string> Missing() {
    Process install({TELLTALE_SOURCE_DIR "/tests/deploy/from_npm",
                     TELLTALE_SOURCE_DIR "/tests/client/recording/foreign", kFolder});
    const auto code = install.Wait();
    if (code == 0) return std::nullopt;
    if (code == 77) return install.output();
    throw std::runtime_error(install.output());
  }

  /// They send to a UDP port of this machine, or over TCP: "tcp:PORT" is listened on; `seconds` of
  /// data at ten times real time after SIGUSR2. They deny the interval of message `denied`.
  static std::vector<std::string> Command(const std::string& place, int seconds, int loss_every,
                                          int denied = 0) {
    return {"/usr/bin/env",
            "node",
            std::string(kFolder) + "/send_live.mjs",
            place,
            "2",
            std::to_string(seconds),
            std::to_string(loss_every),
            "10",
            std::to_string(denied)};
  }

 private:
  static constexpr const char* kFolder = TELLTALE_BINARY_DIR "/live_sender";
};

}  // namespace telltale
