#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace telltale {

/// Copies the databases of a state directory into `to`, each as it is at one moment, while a daemon
/// uses them. Returns the names of the files. Throws SQLite::Exception or std::runtime_error, which
/// name the file, where one cannot be read or written, or where `to` holds one already.
std::vector<std::string> BackUp(const std::filesystem::path& state_directory,
                                const std::filesystem::path& to);

/// Puts the databases of a backup in the place of those of a state directory, which are set aside
/// as FILE.replaced-TIME. Returns the names of the files. Throws as BackUp(), before it changes
/// anything, where a database of the backup is damaged or where there is none, and as DirectoryLock
/// where a daemon uses the directory.
std::vector<std::string> RestoreBackup(const std::filesystem::path& from,
                                       const std::filesystem::path& state_directory);

}  // namespace telltale
