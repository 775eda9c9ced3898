#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "telltale/core/base/result.hpp"

namespace telltale {

/// How large a compressed recording may become: more is a mistake or malice.
inline constexpr std::uint64_t kMostInflatedBytes = 64'000'000'000;

/// Why a compressed recording is not read that becomes larger.
Refusal TooMuchInflated(const std::filesystem::path& compressed, std::uint64_t most_bytes);

/// The file that a compressed one is inflated into. It never takes the last tenth of the free space
/// of its disk, which others need.
class InflatedFile {
 public:
  InflatedFile(const std::filesystem::path& compressed, const std::filesystem::path& into,
               std::uint64_t most_bytes = kMostInflatedBytes);

  /// False: it takes no more, for the reason that Close() gives.
  bool Write(const void* bytes, std::size_t count);

  /// Why not all could be written; nothing: all was.
  std::optional<Refusal> Close();

 private:
  std::string compressed_;
  std::filesystem::path path_;
  std::ofstream out_;
  std::uint64_t most_bytes_;
  bool is_bound_by_disk_;
  std::uint64_t written_ = 0;  ///< what was to be written included
};

}  // namespace telltale
