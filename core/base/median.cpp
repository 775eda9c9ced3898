#include "telltale/core/base/median.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"

namespace telltale {

double Median(std::vector<double> values) {
  Require(!values.empty(), "at least one value");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace telltale
