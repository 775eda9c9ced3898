#include "telltale/idl/codec/codec_error.hpp"

#include <algorithm>

namespace telltale {
namespace {

constexpr std::size_t kShownOfValue = 200;

/// The value as one short line: a sender may have put anything in it.
std::string Shown(const std::string& value) {
  if (value.empty()) return "(unset)";
  std::string shown = value.substr(0, kShownOfValue);
  std::ranges::replace_if(
      shown, [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  if (value.size() > kShownOfValue) {
    shown += "... (" + std::to_string(value.size()) + " characters)";
  }
  return shown;
}

}  // namespace

std::string CodecError::Message() const {
  const std::string place = where.empty() ? "" : where + ": ";
  return place + field + " = " + Shown(value) + ": " + allowed;
}

}  // namespace telltale
