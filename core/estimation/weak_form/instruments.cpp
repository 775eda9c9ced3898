#include "telltale/core/estimation/weak_form/instruments.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "telltale/core/simulation/divergence.hpp"

namespace telltale {
namespace {

constexpr double kRestartPeriodS = 10.0;

double Clamped(double value, double limit) {
  return std::isfinite(value) ? std::clamp(value, -limit, limit) : 0.0;
}

Eigen::Index ColumnsOf(const WeakProblem& problem, Equation equation) {
  return std::ssize(Regressors(equation, problem.parameterization)) +
         static_cast<Eigen::Index>(problem.recording_bias_terms.Count());
}

/// For each equation, the equation whose projection serves it. Sway and yaw have the same
/// regressors, so the projection of sway serves both where their supports are the same.
std::array<std::size_t, 3> SharedProjections(const WeakProblem& problem,
                                             const std::array<bool, 3>& simulated) {
  const std::size_t surge = IndexOf(Equation::kSurge);
  const std::size_t sway = IndexOf(Equation::kSway);
  const std::size_t yaw = IndexOf(Equation::kYaw);
  const bool same = simulated[sway] && simulated[yaw] &&
                    problem.supports[sway].first_rows == problem.supports[yaw].first_rows;
  return {surge, sway, same ? sway : yaw};
}

}  // namespace

Instruments::Instruments(const PreparedDataset& dataset, const WeakProblem& problem)
    : dataset_(dataset),
      problem_(problem),
      fastest_(FastestOf(dataset)),
      kernel_(FilterOnIntervals(dataset)),
      smoothed_phi_(FilteredTestFunction(kernel_, problem.phi)) {
  const double h = dataset.sampling_period_s;
  restart_rows_ =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kRestartPeriodS / h)));
  // On top of the rows that the supports themselves need, which the filter adds to.
  lead_in_rows_ = std::max(problem.phi.Rows() / 2 + 1, dataset.options.smoothing_half_width);
}

std::array<PredictedSupports, 3> Instruments::Predict(
    const VesselModel& model, const std::vector<ConstantDisturbance>& disturbances,
    const std::array<std::vector<std::size_t>, 3>& columns, const FilteredThrust& thrust) const {
  const BodyDynamics dynamics(model);
  std::array<bool, 3> simulated{};
  std::ranges::transform(columns, simulated.begin(), [](const auto& of) { return !of.empty(); });
  const std::array<std::size_t, 3> projected_as = SharedProjections(problem_, simulated);
  std::array<PredictedSupports, 3> whole = ZeroSupports(simulated, projected_as);
  std::vector<PredictedInstant> predicted(dataset_.rows.size());
  for (const Part& part : Parts()) {
    Simulate(dynamics, disturbances[part.recording], simulated, thrust, part, predicted);
    const std::span<const PredictedInstant> rows(predicted.data() + part.rows.begin,
                                                 part.rows.size());
    const FilteringLoss loss(rows, kernel_);
    const DelayDerivatives derivatives(
        dynamics, rows, std::span(thrust.filtered).subspan(part.rows.begin, part.rows.size()),
        dataset_.sampling_period_s);
    for (std::size_t j = 0; j < whole.size(); ++j) {
      if (whole[j].Z.size() > 0) ProjectPart(j, thrust, predicted, part, loss, whole[j]);
      if (simulated[j]) AddDelayDerivatives(j, part, derivatives, whole[j].by_delay);
    }
  }
  std::array<PredictedSupports, 3> sought;
  for (std::size_t j = 0; j < sought.size(); ++j) {
    if (!simulated[j]) continue;
    const PredictedSupports& supports = whole[projected_as[j]];
    sought[j] = {supports.Z(Eigen::all, columns[j]),
                 supports.filtering_loss(Eigen::all, columns[j]), std::move(whole[j].by_delay)};
  }
  return sought;
}

/// Of every column, sought or not, for the equations that are projected themselves; of the delays,
/// for all that are simulated.
std::array<PredictedSupports, 3> Instruments::ZeroSupports(
    const std::array<bool, 3>& simulated, const std::array<std::size_t, 3>& projected_as) const {
  std::array<PredictedSupports, 3> whole;
  for (std::size_t j = 0; j < whole.size(); ++j) {
    if (!simulated[j]) continue;
    const auto supports = std::ssize(problem_.supports[j].first_rows);
    whole[j].by_delay.resize(supports, DelayDerivatives::kDelays);
    if (projected_as[j] != j) continue;
    whole[j].Z.resize(supports, ColumnsOf(problem_, kEquations[j]));
    whole[j].filtering_loss = Eigen::MatrixXd::Zero(supports, whole[j].Z.cols());
  }
  return whole;
}

std::vector<Instruments::Part> Instruments::Parts() const {
  const std::size_t half = problem_.phi.Rows() / 2;
  std::vector<Part> parts;
  for (std::size_t s = 0; s < dataset_.segments.size(); ++s) {
    const RowRange& segment = dataset_.segments[s];
    for (std::size_t begin = segment.begin; begin < segment.end; begin += restart_rows_) {
      const RowRange centres{begin, std::min(begin + restart_rows_, segment.end)};
      const std::size_t before = std::min(half + lead_in_rows_, begin - segment.begin);
      const std::size_t behind = half + dataset_.options.smoothing_half_width;
      parts.push_back({dataset_.RecordingOf(s),
                       {begin - before, std::min(centres.end + behind, segment.end)},
                       centres});
    }
  }
  return parts;
}

void Instruments::Simulate(const BodyDynamics& dynamics, const ConstantDisturbance& disturbance,
                           const std::array<bool, 3>& simulated, const FilteredThrust& thrust,
                           const Part& part, std::vector<PredictedInstant>& predicted) const {
  const double h = dataset_.sampling_period_s;
  const PreparedRow& start = dataset_.rows[part.rows.begin];
  predicted[part.rows.begin] = {start.nu, start.eta.psi_rad};
  const Nu limits = kInstrumentDivergence.LimitsFor(fastest_);
  for (std::size_t k = part.rows.begin; k + 1 < part.rows.end; ++k) {
    const NuDot propelled = dynamics.Propelled(thrust.interval[k]);
    const NuDot constant = disturbance.At(predicted[k].psi_rad);
    const Nu next = dynamics.Step(
        {propelled.u + constant.u, propelled.v + constant.v, propelled.r + constant.r},
        predicted[k].nu, h);
    const Nu& measured = dataset_.rows[k + 1].nu;
    PredictedInstant& then = predicted[k + 1];
    then.nu = {simulated[0] ? Clamped(next.u, limits.u) : measured.u,
               simulated[1] ? Clamped(next.v, limits.v) : measured.v,
               simulated[2] ? Clamped(next.r, limits.r) : measured.r};
    then.psi_rad = predicted[k].psi_rad + h * (predicted[k].nu.r + then.nu.r) / 2.0;
  }
}

/// The rows of a part: regressors, then recording bias terms.
RegressorRows Instruments::PredictedRows(Equation equation, const FilteredThrust& thrust,
                                         const std::vector<PredictedInstant>& predicted,
                                         const Part& part) const {
  const Eigen::Index columns = ColumnsOf(problem_, equation);
  const std::size_t bias_terms = problem_.recording_bias_terms.Count();
  const std::size_t regressors = static_cast<std::size_t>(columns) - bias_terms;
  RegressorRows rows(static_cast<Eigen::Index>(part.rows.size()), columns);
  for (std::size_t k = part.rows.begin; k < part.rows.end; ++k) {
    double* const row = rows.row(static_cast<Eigen::Index>(k - part.rows.begin)).data();
    FillRow(equation, predicted[k].nu, thrust.filtered[k], {row, regressors});
    problem_.recording_bias_terms.Fill(part.recording, predicted[k].psi_rad,
                                       {row + regressors, bias_terms});
  }
  return rows;
}

/// Calls visit(support, its first row in the part) for each support centred in the part.
template <class Visit>
void Instruments::ForEachSupport(std::size_t equation, const Part& part, Visit visit) const {
  const auto& first_rows = problem_.supports[equation].first_rows;
  const std::size_t half = problem_.phi.Rows() / 2;
  const std::size_t first_centred = part.centres.begin - std::min(part.centres.begin, half);
  for (auto at = std::ranges::lower_bound(first_rows, first_centred);
       at != first_rows.end() && *at + half < part.centres.end; ++at) {
    if (*at + half < part.centres.begin) continue;
    visit(at - first_rows.begin(), static_cast<Eigen::Index>(*at - part.rows.begin));
  }
}

void Instruments::ProjectPart(std::size_t equation, const FilteredThrust& thrust,
                              const std::vector<PredictedInstant>& predicted, const Part& part,
                              const FilteringLoss& loss, PredictedSupports& supports) const {
  const Equation name = kEquations[equation];
  const RegressorRows rows = PredictedRows(name, thrust, predicted, part);
  const Eigen::VectorXd& weights = problem_.phi.value;
  Eigen::RowVectorXd sum(rows.cols());
  ForEachSupport(equation, part, [&](Eigen::Index support, Eigen::Index first) {
    sum.noalias() = weights.transpose() * rows.middleRows(first, weights.size());
    const Eigen::RowVectorXd filtering_loss =
        loss.Over(first, name == Equation::kSurge, smoothed_phi_, weights);
    supports.Z.row(support) = sum;
    supports.filtering_loss.row(support).head(filtering_loss.size()) = filtering_loss;
  });
}

void Instruments::AddDelayDerivatives(std::size_t equation, const Part& part,
                                      const DelayDerivatives& derivatives,
                                      Eigen::MatrixXd& by_delay) const {
  ForEachSupport(equation, part, [&](Eigen::Index support, Eigen::Index first) {
    by_delay.row(support) = derivatives.Over(first, equation, problem_.phi);
  });
}

}  // namespace telltale
