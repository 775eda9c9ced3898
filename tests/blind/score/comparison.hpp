#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "score/tables.hpp"

namespace blind::score {

/// Some case has no report yet, so that no label may be opened.
struct ReportsMissing : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Comparison {
  std::vector<Method> methods;
  std::size_t cases = 0;  // scored, the same for all
};

/// Scores each folder of reports against the labels of the set. No label is opened before every
/// report has been read; with `partial` cases count that all folders report on. Throws
/// ReportsMissing, or std::invalid_argument naming the file that cannot be read.
/// A report without detectabilities, as baselines write them, is counted by those of the first
/// folder. Beside the reports of a folder there may be left-out/NNN.json, of the same case with the
/// true effect left out of the library.
Comparison Scores(const std::filesystem::path& set,
                  const std::vector<std::filesystem::path>& folders, bool partial);

/// The same of one folder, case by case.
std::vector<Scored> ScoredCases(const std::filesystem::path& set,
                                const std::filesystem::path& folder, bool partial);

/// Case and true effect of each single effect, to be diagnosed again without it. Opens labels under
/// the conditions of Scores, and throws as it does.
std::vector<std::pair<std::string, std::string>> SingleEffects(
    const std::filesystem::path& set, const std::vector<std::filesystem::path>& folders,
    bool partial);

}  // namespace blind::score
