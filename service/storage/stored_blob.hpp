#pragma once

#include <google/protobuf/message_lite.h>

#include "telltale/idl/codec/checksum.hpp"
#include "telltale/service/storage/database.hpp"

namespace telltale {

/// Whether the row has no checksum, or that of these bytes.
inline bool HasChecksumOf(const Row& row, std::string_view bytes) {
  return row.IsNull("checksum") || row.Integer("checksum") == ChecksumOf(bytes);
}

/// Reads the message that a column of the row holds. False where a bit of it has changed, and where
/// it is something else.
inline bool ReadBlob(const Row& row, const char* column, google::protobuf::MessageLite& message) {
  const std::string bytes = row.Bytes(column);
  return HasChecksumOf(row, bytes) && message.ParseFromString(bytes);
}

}  // namespace telltale
