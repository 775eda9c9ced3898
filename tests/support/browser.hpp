#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

#include "support/run_command.hpp"

namespace telltale {

/// A Chromium on the path, if there is one.
inline std::optional<std::filesystem::path> FindBrowser() {
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
      const std::filesystem::path program = std::filesystem::path(folder) / name;
      if (std::filesystem::is_regular_file(program)) return program;
    }
  }
  return std::nullopt;
}

/// The document as it stands once its scripts have run; empty where the browser fails.
inline std::string DocumentInBrowser(const std::filesystem::path& browser,
                                     const std::filesystem::path& page) {
  const TemporaryFolder profile;
  return RunCommand({"timeout", "60", browser.string(), "--headless", "--no-sandbox",
                     "--disable-gpu", "--disable-quic", "--no-first-run",
                     "--disable-background-networking", "--disable-component-update",
                     "--disable-sync", "--virtual-time-budget=5000", "--window-size=1400,900",
                     "--user-data-dir=" + profile.Path().string(), "--dump-dom",
                     "file://" + page.string()})
      .out;
}

}  // namespace telltale
