#include "telltale/core/uncertainty/coverage.hpp"

#include "telltale/core/base/contract.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {

void Tally::Add(bool one_held) {
  held += one_held ? 1 : 0;
  of += 1;
}

double Tally::Share() const {
  return of == 0 ? 0.0 : static_cast<double>(held) / static_cast<double>(of);
}

Interval BinomialInterval(const Tally& tally, double level) {
  Require(tally.held <= tally.of, "no more held than there were");
  Require(level > 0.0 && level < 1.0, "a level between 0 and 1");
  if (tally.of == 0) return {level, 0.0, 1.0};
  const auto trials = static_cast<double>(tally.of);
  const auto successes = static_cast<double>(tally.held);
  const double tail = 0.5 * (1.0 - level);
  return {level, BinomialLowerBound(trials, successes, tail),
          BinomialUpperBound(trials, successes, tail)};
}

Interval CoefficientCoverage::Bounds() const {
  return BinomialInterval(tally, kCoverageLevel);
}

}  // namespace telltale
