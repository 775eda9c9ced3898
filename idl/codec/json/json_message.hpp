#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <google/protobuf/message.h>

#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// Message -> indented JSON by Protobuf's mapping: lowerCamelCase, zeros and empty lists printed,
/// numbers that read back to the same bits, infinities as "Infinity".
std::string PrintJsonMessage(const google::protobuf::Message& message);

/// The same in one line, without a line feed at its end.
std::string PrintJsonLine(const google::protobuf::Message& message);

/// JSON -> message. Refuses text that is not JSON, unknown fields and values of the wrong type.
std::optional<CodecError> ParseJsonMessage(std::string_view text, const std::string& file,
                                           google::protobuf::Message& message);

}  // namespace telltale
