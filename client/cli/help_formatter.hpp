#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace telltale {

/// Help whose descriptions are wrapped for a terminal.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace telltale
