#include "telltale/client/bridge/mavlink_address.hpp"

#include <charconv>
#include <optional>
#include <string_view>

namespace telltale {
namespace {

std::optional<std::uint32_t> NumberWithinRange(std::string_view text, std::uint32_t lowest,
                                               std::uint32_t highest) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || number < lowest || number > highest) return std::nullopt;
  return number;
}

/// A host without the brackets of IPv6.
std::string HostOf(std::string_view host) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  return std::string(host);
}

}  // namespace

tl::expected<MavlinkAddress, std::string> ParseMavlinkAddress(const std::string& text) {
  using Kind = MavlinkAddress::Kind;
  const std::string_view all = text;
  const std::size_t first = all.find(':');
  const std::string_view scheme = all.substr(0, first);
  const Kind kind = scheme == "udp"      ? Kind::kUdp
                    : scheme == "tcp"    ? Kind::kTcp
                    : scheme == "serial" ? Kind::kSerial
                                         : Kind::kUnknown;
  if (kind == Kind::kUnknown || first == std::string_view::npos) {
    return tl::unexpected(text + " must be udp:HOST:PORT, tcp:HOST:PORT or serial:DEVICE:BAUD");
  }
  const bool serial = kind == Kind::kSerial;
  const std::string_view rest = all.substr(first + 1);
  const std::size_t last = rest.rfind(':');
  if (last == std::string_view::npos || last == 0) {
    return tl::unexpected(text + " must be " + std::string(scheme) +
                          (serial ? ":DEVICE:BAUD" : ":HOST:PORT"));
  }
  const std::string_view digits = rest.substr(last + 1);
  const auto number =
      serial ? NumberWithinRange(digits, 1200, 4000000) : NumberWithinRange(digits, 1, 65535);
  if (!number) {
    return tl::unexpected(text + ": " +
                          (serial ? "the baud must be within [1200, 4000000]"
                                  : "the port must be within [1, 65535]") +
                          ", not '" + std::string(digits) + "'");
  }
  const std::string_view place = rest.substr(0, last);
  return MavlinkAddress{kind, serial ? std::string(place) : HostOf(place), *number};
}

}  // namespace telltale
