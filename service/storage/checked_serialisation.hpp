#pragma once

#include <stdexcept>
#include <string>

#include <google/protobuf/message_lite.h>

#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// The bytes of a message, given what reading the message back returns. Throws std::runtime_error,
/// which names the field, where it cannot be read back: after a restart the daemon could not read
/// it, and no client could read it now.
template <class T>
std::string SerialiseChecked(const google::protobuf::MessageLite& message,
                             const Decoded<T>& read_back) {
  if (!read_back) {
    throw std::runtime_error("not published, since it cannot be read back: " +
                             read_back.error().Message());
  }
  return message.SerializeAsString();
}

}  // namespace telltale
