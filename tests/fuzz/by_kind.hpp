#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "telltale/idl/codec/protobuf_log.hpp"

namespace telltale {

using Bytes = std::span<const std::uint8_t>;

/// The body of a fuzz target: the first byte of an input says as what `insist` reads the others.
inline int InsistByKind(const std::uint8_t* data, std::size_t size,
                        void (*insist)(std::uint8_t kind, Bytes bytes)) {
  static const bool silenced = (SilenceProtobufLog(), true);
  if (silenced && size > 0) insist(data[0], {data + 1, size - 1});
  return 0;
}

inline std::string_view TextOf(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace telltale
