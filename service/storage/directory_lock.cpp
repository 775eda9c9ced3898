#include "telltale/service/storage/directory_lock.hpp"

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace telltale {
namespace {

/// The process number that the holder has written; empty where it has written none.
std::string HolderOf(int file) {
  std::array<char, 32> text{};
  const ssize_t size = pread(file, text.data(), text.size(), 0);
  return size > 0 ? " (process " + std::string(text.data(), static_cast<std::size_t>(size)) + ")"
                  : "";
}

}  // namespace

DirectoryLock::DirectoryLock(const std::filesystem::path& directory) : file_(-1) {
  std::filesystem::create_directories(directory);
  const std::string path = (directory / "lock").string();
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
  if (file_ < 0) throw std::system_error(errno, std::generic_category(), path);
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const std::string holder = HolderOf(file_);
    close(file_);
    throw std::runtime_error("state_directory " + directory.string() +
                             " is in use by another telltaled" + holder +
                             ": stop that one, or name another directory");
  }
  const std::string process = std::to_string(getpid());
  if (ftruncate(file_, 0) != 0 || write(file_, process.data(), process.size()) < 0) {
    const int error = errno;
    close(file_);
    throw std::system_error(error, std::generic_category(), path);
  }
}

DirectoryLock::~DirectoryLock() {
  close(file_);
}

}  // namespace telltale
