#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

namespace telltale {

/// Where a subcommand's answer goes: a table for people, unless standard output is to have the
/// JSON.
struct OutputOptions {
  std::filesystem::path out;  ///< empty: no file
  bool json = false;

  void AddTo(CLI::App& command, const std::string& file_name);

  /// Writes `json` to the file if one was named, and it or the table to standard output.
  void Write(const std::string& json_text, const std::function<std::string()>& table) const;
};

}  // namespace telltale
