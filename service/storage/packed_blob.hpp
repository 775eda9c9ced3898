#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace telltale {

/// The bytes compressed, with a checksum in front.
std::string PackBlob(std::string_view bytes);

/// The way back. Nothing where a bit of the blob has changed, or where it is something else.
std::optional<std::string> UnpackBlob(std::string_view blob);

}  // namespace telltale
