#include "telltale/core/estimation/output_error/shooting_plan.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/data/time_series.hpp"
#include "telltale/core/estimation/regression/entering_rows.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

constexpr double kLongestStepS = 0.2;
constexpr std::size_t kFewestFixes = 4;
constexpr std::size_t kFewestHeadings = 3;

bool SameCommand(const PropellerCommand& a, const PropellerCommand& b) {
  return a.port == b.port && a.starboard == b.starboard;
}

/// Equal parts of a run: each from its first row to the first of the next, or to the run's last.
std::vector<RowRange> CutRun(const RowRange& run, double rows_per_shooting_segment) {
  constexpr double kShortestShare = 0.5;
  const double intervals = static_cast<double>(run.size()) - 1.0;
  if (intervals < kShortestShare * rows_per_shooting_segment) return {};
  const auto parts =
      static_cast<std::size_t>(std::max(1.0, std::round(intervals / rows_per_shooting_segment)));
  std::vector<RowRange> cut;
  for (std::size_t i = 0; i < parts; ++i) {
    cut.push_back(
        {run.begin + (run.size() - 1) * i / parts, run.begin + (run.size() - 1) * (i + 1) / parts});
  }
  return cut;
}

/// Builds the shooting segments of one segment of the dataset.
class SegmentCutter {
 public:
  SegmentCutter(const PreparedDataset& dataset, std::size_t segment, const SharedUnknowns& unknowns,
                const ShootingOptions& options)
      : dataset_(dataset),
        commands_(dataset.commands[segment]),
        signals_(dataset.signals[segment]),
        unknowns_(unknowns),
        options_(options) {}

  /// The shooting segment between two rows; measurements at `end_s` belong to it only if `closed`.
  ShootingSegment Between(const RowRange& rows, bool closed) const {
    const PreparedRow& first = dataset_.rows[rows.begin];
    const double end_s = dataset_.rows[rows.end].time_s;
    ShootingSegment shooting_segment;
    shooting_segment.guess << 0.0, 0.0, first.eta.psi_rad, first.nu.u, first.nu.v, first.nu.r;
    shooting_segment.before = Remembered(first.time_s);
    const std::vector<double> times = NodeTimes(first.time_s, end_s);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool last = k + 1 == times.size();
      ShootingNode node;
      if (!last || closed) node.fix = FixAt(times[k], first.eta);
      if (!last) {
        node.leg_s = times[k + 1] - times[k];
        node.steady = Steady(commands_.At(times[k]));
        const bool closing = closed && k + 2 == times.size();
        node.heading = MeanOver(times[k], times[k + 1], closing);
      }
      shooting_segment.fixes += node.fix ? 1 : 0;
      shooting_segment.headings += node.heading ? 1 : 0;
      shooting_segment.nodes.push_back(node);
    }
    return shooting_segment;
  }

 private:
  ThrustRegressors Steady(const PropellerCommand& delta) const {
    return ThrustOf(unknowns_.parameterization, unknowns_.dead_zone.Apply(delta));
  }

  std::vector<ShootingSegment::Held> Remembered(double until_s) const {
    std::vector<ShootingSegment::Held> before;
    const double from_s = std::max(until_s - kThrusterMemoryS, commands_.Times().front());
    // At least one command, on which the thrusters have settled.
    if (!unknowns_.lagging || from_s >= until_s) return {{Steady(commands_.At(until_s)), 0.0}};
    std::optional<PropellerCommand> held;
    commands_.ForEachPiece(from_s, until_s,
                           [&](const PropellerCommand& delta, double start, double end) {
                             if (held && SameCommand(*held, delta)) {
                               before.back().duration_s += end - start;
                             } else {
                               before.push_back({Steady(delta), end - start});
                             }
                             held = delta;
                           });
    return before;
  }

  std::vector<double> NodeTimes(double begin_s, double end_s) const {
    std::vector<double> stops = {begin_s, end_s};
    const auto within = [&](double t) {
      return t > begin_s + kSameInstantS && t < end_s - kSameInstantS;
    };
    for (const double t : signals_.north_m.times_s) {
      if (within(t)) stops.push_back(t);
    }
    for (std::size_t i = 1; i < commands_.Times().size(); ++i) {
      const bool changes = !SameCommand(commands_.Commands()[i - 1], commands_.Commands()[i]);
      if (changes && within(commands_.Times()[i])) stops.push_back(commands_.Times()[i]);
    }
    std::sort(stops.begin(), stops.end());
    std::vector<double> times = {begin_s};
    for (const double stop : stops) {
      const double from = times.back();
      if (stop - from <= kSameInstantS) continue;
      const double steps = std::ceil((stop - from) / kLongestStepS - kSameInstantS);
      for (double i = 1.0; i < steps; ++i) times.push_back(from + i * (stop - from) / steps);
      times.push_back(stop);
    }
    return times;
  }

  std::optional<NorthEastPosition> FixAt(double t, const Eta& from) const {
    const auto& times = signals_.north_m.times_s;
    const auto at = std::lower_bound(times.begin(), times.end(), t - kSameInstantS);
    if (at == times.end() || *at > t + kSameInstantS) return std::nullopt;
    const auto i = static_cast<std::size_t>(at - times.begin());
    return NorthEastPosition{signals_.north_m.values[i] - from.x_m,
                             signals_.east_m.values[i] - from.y_m};
  }

  std::optional<MeanHeading> MeanOver(double from_s, double to_s, bool closing) const {
    const auto& times = signals_.psi_rad.times_s;
    const double until_s = closing ? to_s + kSameInstantS : to_s - kSameInstantS;
    const auto begin = std::lower_bound(times.begin(), times.end(), from_s - kSameInstantS);
    const auto end = std::lower_bound(begin, times.end(), until_s);
    if (begin == end) return std::nullopt;
    MeanHeading mean;
    const double leg_s = to_s - from_s;
    const double share = 1.0 / static_cast<double>(end - begin);
    for (auto at = begin; at != end; ++at) {
      const double s = (*at - from_s) / leg_s;
      const double left = 1.0 - s;
      mean.psi_before += share * left * left * (1.0 + 2.0 * s);
      mean.r_before += share * leg_s * s * left * left;
      mean.psi_after += share * s * s * (3.0 - 2.0 * s);
      mean.r_after -= share * leg_s * s * s * left;
      mean.psi_rad += share * signals_.psi_rad.values[static_cast<std::size_t>(at - times.begin())];
    }
    mean.noise_rad = std::max(options_.least_heading_noise_rad,
                              std::sqrt(share) * dataset_.sensors.heading_noise_rad);
    return mean;
  }

  const PreparedDataset& dataset_;
  const HeldCommands& commands_;
  const RawSignals& signals_;
  const SharedUnknowns& unknowns_;
  const ShootingOptions& options_;
};

std::vector<Equation> SoughtEquations(const SharedUnknowns& unknowns) {
  std::vector<Equation> sought;
  for (const Equation equation : kEquations) {
    if (!unknowns.columns[IndexOf(equation)].empty()) sought.push_back(equation);
  }
  return sought;
}

/// Adds the shooting segments of one segment of the dataset.
void CutSegment(const PreparedDataset& dataset, std::size_t segment_index,
                const EnteringRows& entering, const SharedUnknowns& unknowns,
                const ShootingOptions& options, double cluster_s, ShootingPlan& plan) {
  const double h = dataset.sampling_period_s;
  const RowRange& segment = dataset.segments[segment_index];
  const SegmentCutter cutter(dataset, segment_index, unknowns, options);
  const double parts = ClustersIn(segment.size(), h, cluster_s);
  std::optional<std::size_t> part;
  for (const RowRange& run : entering.RunsIn(segment)) {
    for (const RowRange& rows : CutRun(run, options.length_s / h)) {
      ShootingSegment shooting_segment = cutter.Between(rows, rows.end + 1 == run.end);
      if (shooting_segment.fixes < kFewestFixes || shooting_segment.headings < kFewestHeadings)
        continue;
      const double centre = 0.5 * static_cast<double>(rows.begin + rows.end - 2 * segment.begin);
      const auto in =
          static_cast<std::size_t>(parts * centre / static_cast<double>(segment.size()));
      if (part != in) ++plan.clusters;
      part = in;
      shooting_segment.cluster = plan.clusters - 1;
      plan.shooting_segments.push_back(std::move(shooting_segment));
    }
  }
}

}  // namespace

ShootingPlan CutShootingSegments(const PreparedDataset& dataset,
                                 const RegressionOptions& regression,
                                 const SharedUnknowns& unknowns, const ShootingOptions& options) {
  Require(dataset.signals.size() == dataset.segments.size(), "raw signals of every segment");
  const double recorded_s = static_cast<double>(dataset.rows.size()) * dataset.sampling_period_s;
  const double cluster_s = ClusterLength(options.clusters, recorded_s);
  const EnteringRows entering(dataset, SoughtEquations(unknowns), regression);
  ShootingPlan plan;
  plan.position_noise_m =
      std::max(options.least_position_noise_m, dataset.sensors.position_noise_m);
  plan.antenna = dataset.sensors.antenna;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    CutSegment(dataset, s, entering, unknowns, options, cluster_s, plan);
  }
  return plan;
}

}  // namespace telltale
