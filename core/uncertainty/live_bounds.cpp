#include "telltale/core/uncertainty/live_bounds.hpp"

#include <cmath>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

// A share of the sampling period; prepared rows stand on a grid.
constexpr double kOffGrid = 0.01;

}  // namespace

LiveBounds::LiveBounds(const RegressionOptions& regression, double sampling_period_s,
                       const SlidingOptions& sliding)
    : options_(regression), sampling_period_s_(sampling_period_s) {
  Require(regression.structure == Structure::kStaticQuadratic, "the static structure");
  Require(sampling_period_s > 0.0, "a positive sampling period");
  for (const Equation equation : kEquations) {
    const std::size_t coefficients = Regressors(equation, regression.parameterization).size();
    streams_.push_back({SlidingRegression(coefficients, sliding)});
  }
}

void LiveBounds::Add(const PreparedRow& row) {
  if (last_) {
    const double step = row.time_s - last_->time_s;
    Require(step > 0.0, "times that rise");
    if (std::abs(step - sampling_period_s_) < kOffGrid * sampling_period_s_) {
      for (const Equation equation : kEquations) AddTo(equation, *last_, row);
    } else {
      for (Stream& stream : streams_) stream.unbroken = false;
    }
  }
  last_ = row;
}

void LiveBounds::AddTo(Equation equation, const PreparedRow& now, const PreparedRow& next) {
  Stream& stream = streams_[IndexOf(equation)];
  const bool enters = Enters(now.region, equation, options_);
  if (enters) {
    std::vector<double> phi(Regressors(equation, options_.parameterization).size());
    FillRow(equation, options_.parameterization, now.nu, options_.dead_zone.Apply(now.delta), phi);
    const double y =
        (ComponentOf(next.nu, equation) - ComponentOf(now.nu, equation)) / sampling_period_s_;
    stream.regression.Push(phi, y, stream.unbroken);
  }
  stream.unbroken = enters;
}

Result<SlidingEstimate> LiveBounds::Estimate(Equation equation) const {
  return streams_[IndexOf(equation)].regression.Estimate();
}

}  // namespace telltale
