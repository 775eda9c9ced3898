#include "telltale/core/diagnosis/hypotheses/shapley.hpp"

#include <array>
#include <bit>

#include "telltale/core/base/contract.hpp"

namespace telltale {

std::vector<double> ShapleyShares(const std::vector<double>& values) {
  // The share of all orders of n members in which so many of them come before a given one.
  static const std::array<std::vector<double>, 4> kWeights = {
      std::vector<double>{}, {1.0}, {0.5, 0.5}, {1.0 / 3.0, 1.0 / 6.0, 1.0 / 3.0}};
  const auto members = static_cast<std::size_t>(std::bit_width(values.size()) - 1);
  Require(std::has_single_bit(values.size()) && members >= 1 && members < kWeights.size(),
          "a value for each subset of one to three members");
  const double all = values.back();
  std::vector<double> shares(members, 0.0);
  if (all == 0.0) return shares;
  for (std::size_t i = 0; i < members; ++i) {
    const std::size_t member = std::size_t{1} << i;
    for (std::size_t subset = 0; subset < values.size(); ++subset) {
      if ((subset & member) != 0) continue;
      const auto before = static_cast<std::size_t>(std::popcount(subset));
      shares[i] += kWeights[members][before] * (values[subset | member] - values[subset]);
    }
    shares[i] /= all;
  }
  return shares;
}

}  // namespace telltale
