#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "telltale/client/bridge/mavlink_address.hpp"

namespace telltale {

/// What happens on a link, told on the thread of Run().
struct MavlinkLinkEvents {
  /// Bytes, and who sent them. `whole`: they are a datagram, which holds whole frames.
  std::function<void(const std::string& sender, std::span<const std::uint8_t> bytes, bool whole)>
      received;
  std::function<void()> second;                         ///< another second has gone by
  std::function<void(const std::string& what)> report;  ///< for people: lost, connected again
};

/// A UDP port that vehicles send to, a TCP connection to one or to a router, or a serial line. A
/// connection or a line that is lost is opened again every second.
class MavlinkLink {
 public:
  /// Binds the port, finds the host or opens the device; a TCP connection is made by Run().
  /// Throws: std::runtime_error naming the address and what is wrong.
  explicit MavlinkLink(const MavlinkAddress& address);
  MavlinkLink(const MavlinkLink&) = delete;
  MavlinkLink& operator=(const MavlinkLink&) = delete;
  ~MavlinkLink();

  /// Receives until Stop().
  void Run(const MavlinkLinkEvents& events);

  /// Ends Run(), also one that is yet to begin. Any thread may call it.
  void Stop();

  /// Why nothing can be received now, where a connection or a line is lost. From the thread of
  /// Run() alone.
  std::optional<std::string> Fault() const;

  /// Sends to who has sent before; what cannot be sent is lost, as on any link. From the thread of
  /// Run() alone.
  void Send(const std::string& sender, std::span<const std::uint8_t> bytes);

 private:
  class Transport;
  class Datagrams;
  class Connection;
  class SerialLine;

  std::unique_ptr<Transport> transport_;
};

}  // namespace telltale
