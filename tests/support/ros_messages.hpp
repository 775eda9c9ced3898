#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace telltale {

/// Little-endian CDR, aligned as OMG DDS-XTypes 7.4 says.
class Cdr {
 public:
  template <class Number>
  Cdr& Add(Number value) {
    while ((bytes_.size() - 4) % sizeof(Number) != 0) bytes_.push_back(0);
    std::uint64_t raw = 0;
    if constexpr (std::is_same_v<Number, double>) {
      raw = std::bit_cast<std::uint64_t>(value);
    } else {
      raw = static_cast<std::uint64_t>(value);
    }
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      bytes_.push_back(static_cast<std::uint8_t>(raw >> (8 * i) & 0xFF));
    }
    return *this;
  }
  Cdr& AddText(const std::string& text) {
    Add(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text) bytes_.push_back(static_cast<std::uint8_t>(c));
    bytes_.push_back(0);
    return *this;
  }
  Cdr& AddHeader(std::int32_t seconds, const std::string& frame = "map") {
    return Add(seconds).Add(std::uint32_t{0}).AddText(frame);
  }
  const std::vector<std::uint8_t>& Bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_ = {0, 1, 0, 0};
};

inline std::vector<std::uint8_t> NavSatFix(std::int32_t seconds, std::int8_t status) {
  return Cdr().AddHeader(seconds).Add(status).Add(std::uint16_t{1}).Add(63.4).Add(10.4).Bytes();
}

inline std::vector<std::uint8_t> Imu(std::int32_t seconds, double yaw_rad,
                                     const std::string& frame) {
  Cdr cdr;
  cdr.AddHeader(seconds, frame).Add(0.0).Add(0.0);
  cdr.Add(std::sin(yaw_rad / 2)).Add(std::cos(yaw_rad / 2));
  for (int i = 0; i < 9; ++i) cdr.Add(0.0);
  return cdr.Bytes();
}

/// What geographic_msgs/GeoPoseStamped and nav_msgs/Odometry share: a place of three numbers, z
/// being zero, and a yaw.
inline Cdr& AddPose(Cdr& cdr, double first, double second, double yaw_rad) {
  cdr.Add(first).Add(second).Add(0.0).Add(0.0).Add(0.0);
  return cdr.Add(std::sin(yaw_rad / 2)).Add(std::cos(yaw_rad / 2));
}

inline std::vector<std::uint8_t> GeoPose(std::int32_t seconds, double latitude_deg,
                                         double longitude_deg, double yaw_rad) {
  Cdr cdr;
  cdr.AddHeader(seconds, "base_link");
  return AddPose(cdr, latitude_deg, longitude_deg, yaw_rad).Bytes();
}

inline std::vector<std::uint8_t> Odometry(std::int32_t seconds, double x_m, double y_m,
                                          double yaw_rad, const std::string& frame = "odom") {
  Cdr cdr;
  cdr.AddHeader(seconds, frame).AddText("base_link");
  return AddPose(cdr, x_m, y_m, yaw_rad).Bytes();
}

inline std::vector<std::uint8_t> RcOut(std::int32_t seconds, std::vector<std::uint16_t> channels) {
  Cdr cdr;
  cdr.AddHeader(seconds).Add(static_cast<std::uint32_t>(channels.size()));
  for (const std::uint16_t us : channels) cdr.Add(us);
  return cdr.Bytes();
}

}  // namespace telltale
