#pragma once

#include <CLI/CLI.hpp>

#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/client/workbench/identify_choices.hpp"

namespace telltale {

/// What `telltale identify` was asked.
struct IdentifyArguments {
  LogInputs inputs;
  IdentifyChoices choices;
  bool discrete = false;
  OutputOptions output;

  /// The options that say how to identify and how to answer, but not whom.
  void AddOptionsTo(CLI::App& command);
};

}  // namespace telltale
