#pragma once

#include <string>
#include <vector>

#include "score/figures.hpp"

namespace blind::score {

/// One folder of reports.
struct Method {
  std::string name;
  Figures figures;
};

/// All figures as Markdown: one column a folder, then for each folder a row an effect.
std::string Markdown(const std::vector<Method>& methods, std::size_t cases);

}  // namespace blind::score
