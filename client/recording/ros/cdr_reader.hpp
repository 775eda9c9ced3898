#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace telltale {

/// Fields of a message in the Common Data Representation (XCDR1), as ROS 2 stores and sends it:
/// four bytes of encapsulation, then fields aligned to their size.
/// The serialisation of ROS 1 is the same without encapsulation, alignment and closing zeros of
/// strings, always little-endian.
/// A field beyond the end is zero or empty, and Ok() is false from then on.
/// Source: OMG DDS-XTypes 1.3, section 7.4; plain CDR of either byte order.
class CdrReader {
 public:
  enum class Encoding { kCdr, kRos1 };

  explicit CdrReader(std::span<const std::uint8_t> bytes, Encoding encoding = Encoding::kCdr)
      : bytes_(bytes), is_ros1_(encoding == Encoding::kRos1) {
    ok_ = is_ros1_;
    if (is_ros1_) return;
    ok_ = bytes.size() >= kEncapsulation && bytes[0] == 0 && bytes[1] <= 1;
    if (!ok_) return;
    is_little_ = bytes[1] == 1;
    bytes_ = bytes.subspan(kEncapsulation);
  }

  template <class Number>
  [[gnu::always_inline]] Number Read() {
    static_assert(std::is_arithmetic_v<Number>);
    if (!is_ros1_) at_ = (at_ + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number);
    Number value{};
    if (!Holds(sizeof(Number))) return value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return is_little_ == kHostIsLittle ? value : Swapped(value);
  }

  /// Valid as long as the bytes are.
  std::string_view ReadString() {
    const auto length = Read<std::uint32_t>();  // of CDR: its closing zero included
    if (length == 0 || !Holds(length)) return {};
    const std::size_t characters = is_ros1_ ? length : length - 1;
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data() + at_), characters);
    at_ += length;
    return text;
  }

  /// The first values of a sequence, as many as `first` has room for. Returns how many the sequence
  /// has; 0 where it is cut off.
  template <class Number>
  std::size_t ReadSequence(std::span<Number> first) {
    const std::size_t length = Read<std::uint32_t>();
    if (!Holds(length * sizeof(Number))) return 0;
    const std::size_t wanted = std::min(length, first.size());
    for (Number& value : first.first(wanted)) value = Read<Number>();
    at_ += (length - wanted) * sizeof(Number);
    return length;
  }

  bool IsRos1() const { return is_ros1_; }
  bool Ok() const { return ok_; }

 private:
  static constexpr std::size_t kEncapsulation = 4;
  static constexpr bool kHostIsLittle = std::endian::native == std::endian::little;

  /// Out of line: messages of the other byte order are rare.
  template <class Number>
  [[gnu::noinline, gnu::cold]] static Number Swapped(Number value) {
    auto* const raw = reinterpret_cast<std::uint8_t*>(&value);
    std::reverse(raw, raw + sizeof(Number));
    return value;
  }

  bool Holds(std::size_t more) {
    ok_ = ok_ && more <= bytes_.size() && at_ <= bytes_.size() - more;
    return ok_;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool is_little_ = true;
  bool is_ros1_ = false;
  bool ok_ = false;
};

}  // namespace telltale
