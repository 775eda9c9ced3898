#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace telltale {

/// A file of its own in the folder for temporary files, which TMPDIR names, for as long as it
/// lives.
class TemporaryFile {
 public:
  TemporaryFile() : name_((std::filesystem::temp_directory_path() / "telltale-XXXXXX").string()) {
    const int file = mkstemp(name_.data());
    if (file >= 0) close(file);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(name_, ignored);
  }

  std::filesystem::path Path() const { return name_; }

 private:
  std::string name_;
};

}  // namespace telltale
