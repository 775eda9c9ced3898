#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace telltale {

/// What a command left behind.
struct CommandOutcome {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;
  std::string err;
};

inline std::string TextOfFile(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline std::string ShellQuoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Runs a program to its end.
inline CommandOutcome RunCommand(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  std::string line;
  for (const std::string& word : words) line += ShellQuoted(word) + ' ';
  line += "< /dev/null > " + ShellQuoted((folder.Path() / "out").string()) + " 2> " +
          ShellQuoted((folder.Path() / "err").string());
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, TextOfFile(folder.Path() / "out"),
          TextOfFile(folder.Path() / "err")};
}

}  // namespace telltale
