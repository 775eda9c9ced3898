#include "score/comparison.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include "seal.hpp"

namespace blind::score {
namespace {

namespace fs = std::filesystem;

std::string Contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::invalid_argument("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What `parse` makes of the file; its complaints then name the file.
template <typename Parse>
auto ParsedFile(const fs::path& file, Parse parse) {
  try {
    return parse(Contents(file));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(file.string() + ": " + error.what());
  }
}

std::vector<std::string> CaseNames(const fs::path& set) {
  const fs::path cases = set / "cases";
  if (!fs::is_directory(cases)) throw std::invalid_argument("no cases in " + cases.string());
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(cases)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  if (names.empty()) throw std::invalid_argument("no cases in " + cases.string());
  return names;
}

fs::path ReportFile(const fs::path& folder, const std::string& name) {
  return folder / (name + ".json");
}

bool AllReport(const std::vector<fs::path>& folders, const std::string& name) {
  return std::all_of(folders.begin(), folders.end(),
                     [&](const fs::path& folder) { return fs::exists(ReportFile(folder, name)); });
}

/// The cases to score; throws where some are missing that should not.
std::vector<std::string> Reported(const std::vector<std::string>& names,
                                  const std::vector<fs::path>& folders, bool partial) {
  std::vector<std::string> reported;
  std::string missing;
  std::size_t missing_count = 0;
  for (const std::string& name : names) {
    if (AllReport(folders, name)) {
      reported.push_back(name);
    } else if (++missing_count <= 5) {
      missing += " " + name;
    }
  }
  if (reported.empty() || (missing_count > 0 && !partial)) {
    throw ReportsMissing(std::to_string(missing_count) + " of " + std::to_string(names.size()) +
                         " cases have no report yet (" + missing.substr(1) +
                         (missing_count > 5 ? " ..." : "") + "); no label was opened");
  }
  return reported;
}

Report ReadReport(const fs::path& folder, const std::string& name) {
  Report report = ParsedFile(ReportFile(folder, name), ParseReport);
  const fs::path realised = folder / (name + ".realised.json");
  if (fs::exists(realised)) report.realised = ParsedFile(realised, ParseRealised);
  return report;
}

Label OpenLabel(const fs::path& set, const std::string& name) {
  return ParsedFile(set / "labels" / (name + ".sealed"), [&](const std::string& sealed) {
    return ParseLabel(truth::Unsealed(sealed, name));
  });
}

/// Throws where the report names what should not have been in the library.
Report ReadLeftOut(const fs::path& file, const Label& label) {
  Report report = ParsedFile(file, ParseReport);
  for (const std::string& effect : label.effects) {
    if (report.detectability.contains(effect)) {
      throw std::invalid_argument(file.string() + ": " + effect + " was not left out");
    }
  }
  return report;
}

std::string NameOf(const fs::path& folder) {
  const fs::path plain = folder.lexically_normal();
  return (plain.has_filename() ? plain : plain.parent_path()).filename().string();
}

/// The cases of a set and what each folder says of them.
struct Said {
  std::vector<std::string> names;
  std::vector<std::vector<Scored>> columns;  // without labels yet
};

Said ReadAll(const fs::path& set, const std::vector<fs::path>& folders, bool partial) {
  Said said{.names = Reported(CaseNames(set), folders, partial), .columns = {}};
  for (const fs::path& folder : folders) {
    auto& column = said.columns.emplace_back();
    for (const std::string& name : said.names) {
      column.push_back({.label = {}, .report = ReadReport(folder, name), .left_out = {}});
    }
  }
  for (auto& column : said.columns) {
    for (std::size_t row = 0; row < said.names.size(); ++row) {
      auto& own = column[row].report.detectability;
      if (own.empty()) own = said.columns.front()[row].report.detectability;
    }
  }
  return said;
}

/// The labels of all cases, and what is said without the true effect.
void Open(const fs::path& set, const std::vector<fs::path>& folders, Said& said) {
  for (std::size_t column = 0; column < folders.size(); ++column) {
    for (std::size_t row = 0; row < said.names.size(); ++row) {
      Scored& scored = said.columns[column][row];
      scored.label = OpenLabel(set, said.names[row]);
      const fs::path left_out = ReportFile(folders[column] / "left-out", said.names[row]);
      if (fs::exists(left_out)) scored.left_out = ReadLeftOut(left_out, scored.label);
    }
  }
}

}  // namespace

Comparison Scores(const fs::path& set, const std::vector<fs::path>& folders, bool partial) {
  Said said = ReadAll(set, folders, partial);
  Open(set, folders, said);
  Comparison comparison{.methods = {}, .cases = said.names.size()};
  for (std::size_t column = 0; column < folders.size(); ++column) {
    comparison.methods.push_back({NameOf(folders[column]), FiguresOf(said.columns[column])});
  }
  return comparison;
}

std::vector<Scored> ScoredCases(const fs::path& set, const fs::path& folder, bool partial) {
  Said said = ReadAll(set, {folder}, partial);
  Open(set, {folder}, said);
  return said.columns.front();
}

std::vector<std::pair<std::string, std::string>> SingleEffects(const fs::path& set,
                                                               const std::vector<fs::path>& folders,
                                                               bool partial) {
  std::vector<std::pair<std::string, std::string>> singles;
  for (const std::string& name : ReadAll(set, folders, partial).names) {
    const Label label = OpenLabel(set, name);
    if (label.kind == "single") singles.emplace_back(name, *label.effects.begin());
  }
  return singles;
}

}  // namespace blind::score
