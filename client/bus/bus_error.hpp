#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include <dds/dds.h>

namespace telltale {

/// The bus would not do what was asked: what that was, and Cyclone DDS's reason.
class BusError : public std::runtime_error {
 public:
  BusError(std::string_view doing, dds_return_t code)
      : std::runtime_error(std::string(doing) + ": " + dds_strretcode(code)), code_(code) {}

  dds_return_t code() const { return code_; }

 private:
  dds_return_t code_;
};

/// Passes on a handle or count, throws BusError for an error code.
inline dds_return_t Checked(dds_return_t result, std::string_view doing) {
  if (result < 0) throw BusError(doing, result);
  return result;
}

}  // namespace telltale
