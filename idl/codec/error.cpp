#include "codec/error.hpp"

namespace telltale {

std::string CodecError::Message() const {
  return field + " = " + (value.empty() ? "(unset)" : value) + ": " + allowed;
}

}  // namespace telltale
