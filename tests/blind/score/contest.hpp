#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "score/tables.hpp"

namespace blind::score {

/// Some case has no report yet, so that no label may be opened.
struct ReportsMissing : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Contest {
  std::vector<Contestant> contestants;
  std::size_t cases = 0;  // scored, the same for all
};

/// Scores each folder of reports against the labels of the set. No label is opened before every
/// report has been read; with `partial` cases count that all folders report on. Throws
/// ReportsMissing, or std::invalid_argument naming the file that cannot be read.
Contest Scores(const std::filesystem::path& set, const std::vector<std::filesystem::path>& folders,
               bool partial);

}  // namespace blind::score
