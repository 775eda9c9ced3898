#pragma once

#include <stdexcept>
#include <string>

#include <google/protobuf/message_lite.h>

#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// What is kept of a message: its bytes. `again` is what reading it back gives. Throws
/// std::runtime_error naming the field where that cannot be read: it would be lost with this
/// process, and no client could read it either.
template <class T>
std::string SerialiseChecked(const google::protobuf::MessageLite& message,
                             const Decoded<T>& again) {
  if (!again) {
    throw std::runtime_error("not published, as nobody could read it: " + again.error().Message());
  }
  return message.SerializeAsString();
}

}  // namespace telltale
