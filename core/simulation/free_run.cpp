#include "telltale/core/simulation/free_run.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/simulation/divergence.hpp"

namespace telltale {
namespace {

/// Calls visit(first row, states) for runs of `horizon_s` from FreeRunStarts; of many runs for some
/// sixty, spread evenly.
template <typename Visit>
void ForSomeRuns(const PreparedDataset& dataset, const VesselModel& model, double horizon_s,
                 const Visit& visit) {
  constexpr std::size_t kMost = 60;
  const auto steps = static_cast<std::size_t>(std::lround(horizon_s / dataset.sampling_period_s));
  const std::vector<std::size_t> firsts = FreeRunStarts(dataset, steps);
  const ThrustHistory thrust = FollowThrust(dataset, model);
  for (std::size_t i = 0; i < firsts.size(); i += firsts.size() / kMost + 1) {
    visit(firsts[i], RunFreely(dataset, model, thrust, firsts[i], steps));
  }
}

}  // namespace

ThrustHistory FollowThrust(const PreparedDataset& dataset, const VesselModel& model) {
  ThrustHistory history(dataset.rows.size());
  if (model.structure == Structure::kStaticQuadratic) return history;
  for (const RowRange& segment : dataset.segments) {
    if (segment.size() == 0) continue;
    history[segment.begin] = model.SteadyThrust(dataset.rows[segment.begin].delta);
    for (std::size_t k = segment.begin; k + 1 < segment.end; ++k) {
      history[k + 1] =
          model.ThrustAfter(history[k], dataset.rows[k].delta, dataset.sampling_period_s);
    }
  }
  return history;
}

std::vector<VesselState> RunFreely(const PreparedDataset& dataset, const VesselModel& model,
                                   const ThrustHistory& thrust, std::size_t first,
                                   std::size_t steps) {
  const auto& rows = dataset.rows;
  std::vector<VesselState> states = {{rows[first].eta, rows[first].nu, thrust[first]}};
  states.reserve(steps + 1);
  for (std::size_t k = first; k < first + steps; ++k) {
    states.push_back(Advance(model, states.back(), rows[k].delta, dataset.sampling_period_s));
  }
  return states;
}

std::vector<std::size_t> FreeRunStarts(const RowRange& segment, std::size_t steps) {
  std::vector<std::size_t> firsts;
  for (std::size_t k = segment.begin; k + steps < segment.end; k += steps) firsts.push_back(k);
  return firsts;
}

std::vector<std::size_t> FreeRunStarts(const PreparedDataset& dataset, std::size_t steps) {
  std::vector<std::size_t> firsts;
  for (const RowRange& segment : dataset.segments) {
    const auto of_segment = FreeRunStarts(segment, steps);
    firsts.insert(firsts.end(), of_segment.begin(), of_segment.end());
  }
  return firsts;
}

DivergenceCount CountDivergences(const PreparedDataset& dataset, const VesselModel& model,
                                 double horizon_s) {
  const Nu limits = kFreeRunDivergence.LimitsFor(FastestOf(dataset));
  DivergenceCount count;
  ForSomeRuns(dataset, model, horizon_s, [&](std::size_t, const auto& states) {
    ++count.runs;
    if (!std::all_of(states.begin(), states.end(),
                     [&](const VesselState& state) { return Within(state.nu, limits); })) {
      ++count.diverged;
    }
  });
  return count;
}

double FreeRunError(const PreparedDataset& dataset, const VesselModel& model, double horizon_s) {
  constexpr double kMost = 2.0;
  const Nu fastest = FastestOf(dataset);
  const auto square = [&](double off, double unit) {
    const double error = std::abs(off) / unit;
    return error < kMost ? error * error : kMost * kMost;  // NaN takes the limit too
  };
  double squares = 0.0;
  double errors = 0.0;
  ForSomeRuns(dataset, model, horizon_s, [&](std::size_t first, const auto& states) {
    for (std::size_t k = 1; k < states.size(); ++k) {
      const Nu& nu = states[k].nu;
      const Nu& measured = dataset.rows[first + k].nu;
      squares += square(nu.u - measured.u, fastest.u) + square(nu.v - measured.v, fastest.v) +
                 square(nu.r - measured.r, fastest.r);
      errors += 3.0;
    }
  });
  return errors > 0.0 ? std::sqrt(squares / errors) : 0.0;
}

}  // namespace telltale
