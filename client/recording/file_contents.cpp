#include "telltale/client/recording/file_contents.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

namespace telltale {

std::optional<Refusal> NoFile(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return Refusal{path.string(), "is missing", "check the path"};
  }
  if (std::filesystem::is_directory(path, ignored)) {
    return Refusal{path.string(), "is a folder", "give a file"};
  }
  return std::nullopt;
}

Result<std::string> ReadFile(const std::filesystem::path& file) {
  if (auto refusal = NoFile(file)) return tl::unexpected(*std::move(refusal));
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const auto size = stream.tellg();
  std::string content(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  stream.seekg(0);
  stream.read(content.data(), static_cast<std::streamsize>(content.size()));
  if (!stream) return Refuse(file.string(), "cannot be read", "check its permissions");
  return content;
}

void WriteFile(const std::filesystem::path& file, std::string_view content) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) {
    throw std::system_error(errno, std::generic_category(), "cannot write " + file.string());
  }
}

}  // namespace telltale
