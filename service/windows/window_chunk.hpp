#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/data/samples.hpp"
#include "telltale/idl/proto/window_chunk.pb.h"

namespace telltale {

/// The samples of a recording as a message.
proto::WindowChunk ToProto(const Recording& recording);

/// The way back. Nothing where the lists of a channel differ in length.
std::optional<Recording> RecordingOf(const proto::WindowChunk& chunk);

/// The samples of a recording as a compressed blob with a checksum in front.
std::string PackChunk(const Recording& recording);

/// The way back. Nothing where a bit of the blob has changed, or where it is something else.
std::optional<Recording> UnpackChunk(std::string_view blob);

}  // namespace telltale
