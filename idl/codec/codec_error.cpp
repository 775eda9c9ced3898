#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

std::string CodecError::Message() const {
  const std::string place = where.empty() ? "" : where + ": ";
  return place + field + " = " + (value.empty() ? "(unset)" : value) + ": " + allowed;
}

}  // namespace telltale
