#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include "exit_code.hpp"
#include "score/comparison.hpp"

namespace {

struct Arguments {
  std::string set;
  std::vector<std::filesystem::path> reports;
  std::string markdown;
  bool partial = false;
  bool single_effects = false;
};

void AddOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--set-dir", arguments.set, "the set, as blind_truth wrote it")
      ->type_name("DIR")
      ->required()
      ->check(CLI::ExistingDirectory.description(""));
  app.add_option(
         "--reports", arguments.reports,
         "a folder of reports NNN.json, with NNN.realised.json beside them where realised "
         "closure is known and left-out/NNN.json where the case was diagnosed without its true "
         "effect; several for several columns")
      ->type_name("DIR")
      ->required()
      ->check(CLI::ExistingDirectory.description(""));
  app.add_option("--markdown", arguments.markdown, "also write the tables to this file")
      ->type_name("FILE");
  app.add_flag("--partial", arguments.partial, "score the cases that have reports");
  app.add_flag(
      "--single-effects", arguments.single_effects,
      "instead of scoring list case and true effect of the single ones, for diagnosing them "
      "again without it");
}

void ListSingleEffects(const Arguments& arguments) {
  for (const auto& [name, effect] :
       blind::score::SingleEffects(arguments.set, arguments.reports, arguments.partial)) {
    std::cout << name << ' ' << effect << '\n';
  }
}

void Run(const Arguments& arguments) {
  if (arguments.single_effects) return ListSingleEffects(arguments);
  const blind::score::Comparison comparison =
      blind::score::Scores(arguments.set, arguments.reports, arguments.partial);
  const std::string tables = blind::score::Markdown(comparison.methods, comparison.cases);
  std::cout << tables;
  if (arguments.markdown.empty()) return;
  std::ofstream file(arguments.markdown, std::ios::binary);
  file << tables;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + arguments.markdown);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Opens the sealed labels of a set and scores the reports on it");
  app.footer(
      "No label is opened unless every case has a report. What the figures mean: "
      "docs/validation/blind-checks.md\n"
      "Example: blind_score --set-dir development --reports reports --reports best-bic");
  Arguments arguments;
  AddOptions(app, arguments);
  return blind::ExitCodeOf<blind::score::ReportsMissing>(app, "blind_score", argc, argv,
                                                         [&] { Run(arguments); });
}
