#include "telltale/client/cli/output_options.hpp"

#include <iostream>

#include "telltale/client/recording/file_contents.hpp"

namespace telltale {

void OutputOptions::AddTo(CLI::App& command, const std::string& file_name) {
  command.add_option("--out", out, "also write the answer as JSON to this file, " + file_name)
      ->type_name("FILE");
  command.add_flag("--json", json, "print the JSON in place of the table");
}

void OutputOptions::Write(const std::string& json_text,
                          const std::function<std::string()>& table) const {
  if (!out.empty()) WriteFile(out, json_text);
  std::cout << (json ? json_text : table()) << std::flush;
}

}  // namespace telltale
