#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// The oldest version of this software whose model.json this version reads.
inline constexpr std::string_view kOldestModelVersion = "0.2.0";

/// The fault of a model.json whose provenance names an older version: earlier files name their
/// fields differently. Nothing where the version is recent enough, is not stated, or is no version,
/// and where the text is not JSON.
std::optional<CodecError> OutdatedModel(std::string_view text, const std::string& file);

}  // namespace telltale
