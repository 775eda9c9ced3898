#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// Why a path is no file that can be read: it is missing, or a folder.
std::optional<Refusal> NoFile(const std::filesystem::path& path);

/// The bytes of a file. Refuses when: it is missing, a folder, or cannot be read.
Result<std::string> ReadFile(const std::filesystem::path& file);

/// Writes all of `content`, replacing what was there.
/// Throws: std::system_error naming the file when it cannot be written.
void WriteFile(const std::filesystem::path& file, std::string_view content);

}  // namespace telltale
