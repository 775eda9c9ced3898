#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// Protobuf text format -> message, with the line of every field. Nothing is ever printed: the
/// first fault is returned, naming field, value, what is allowed there, and file:line.
std::optional<CodecError> ParseTextMessage(std::string_view text, const std::string& file,
                                           google::protobuf::Message& message,
                                           google::protobuf::TextFormat::ParseInfoTree& lines);

}  // namespace telltale
