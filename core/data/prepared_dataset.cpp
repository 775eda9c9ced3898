#include "telltale/core/data/prepared_dataset.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {

Nu FastestOf(const PreparedDataset& dataset) {
  Nu fastest;
  for (const PreparedRow& row : dataset.rows) {
    fastest.u = std::max(fastest.u, std::abs(row.nu.u));
    fastest.v = std::max(fastest.v, std::abs(row.nu.v));
    fastest.r = std::max(fastest.r, std::abs(row.nu.r));
  }
  return fastest;
}

}  // namespace telltale
