#include "telltale/idl/codec/error.hpp"

namespace telltale {

std::string CodecError::Message() const {
  const std::string place = where.empty() ? "" : where + ": ";
  return place + field + " = " + (value.empty() ? "(unset)" : value) + ": " + allowed;
}

}  // namespace telltale
