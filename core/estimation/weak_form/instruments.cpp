#include "telltale/core/estimation/weak_form/instruments.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/vessel/body_regressors.hpp"

namespace telltale {
namespace {

constexpr double kRestartPeriodS = 10.0;

double Clamped(double value, double limit) {
  return std::isfinite(value) ? std::clamp(value, -limit, limit) : 0.0;
}

template <std::size_t Columns>
using Rows = Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(Columns), Eigen::RowMajor>;

template <class Series>
Series BetweenRows(const Series& rows) {
  const Eigen::Index intervals = rows.rows() - 1;
  return 0.5 * (rows.topRows(intervals) + rows.bottomRows(intervals));
}

Eigen::Index ColumnsOf(const WeakProblem& problem, Equation equation) {
  return std::ssize(Regressors(equation, problem.parameterization)) +
         static_cast<Eigen::Index>(problem.disturbance_terms.Count());
}

/// By equation, whose windows are weighed for it. Sway and yaw have the same regressors: where
/// their windows are the same too, those of sway serve both.
std::array<std::size_t, 3> SharedProjections(const WeakProblem& problem,
                                             const std::array<bool, 3>& simulated) {
  const std::size_t surge = IndexOf(Equation::kSurge);
  const std::size_t sway = IndexOf(Equation::kSway);
  const std::size_t yaw = IndexOf(Equation::kYaw);
  const bool alike = simulated[sway] && simulated[yaw] &&
                     problem.supports[sway].first_rows == problem.supports[yaw].first_rows;
  return {surge, sway, alike ? sway : yaw};
}

/// What windows of products lose to filtering before they are multiplied, by window start.
template <class Series>
auto FilteringLossAt(const Series& between, const Series& filtered, const Eigen::VectorXd& smoothed,
                     const Eigen::VectorXd& phi, Eigen::Index first_interval, Eigen::Index first) {
  return (smoothed.transpose() * between.middleRows(first_interval, smoothed.size()) -
          phi.transpose() * filtered.middleRows(first, phi.size()))
      .eval();
}

}  // namespace

/// Rows that are predicted in one go, and those of them that windows are centred in.
struct Instruments::Part {
  std::size_t recording;
  RowRange rows;
  RowRange centres;
};

/// The body regressors of a part: of the velocities, between rows, and of the filtered velocities.
class Instruments::Bodies {
 public:
  Bodies(const std::vector<Instant>& predicted, const RowRange& part, const Eigen::VectorXd& kernel)
      : filtered_surge_(Rows<5>::Zero(Count(part), 5)),
        filtered_turning_(Rows<9>::Zero(Count(part), 9)),
        half_width_(kernel.size() / 2) {
    const Eigen::Index n = Count(part);
    Rows<3> nu(n, 3);
    Rows<5> surge(n, 5);
    Rows<9> turning(n, 9);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Nu& now = predicted[part.begin + static_cast<std::size_t>(k)].nu;
      nu.row(k) << now.u, now.v, now.r;
      Write(now, k, surge, turning);
    }
    surge_ = BetweenRows(surge);
    turning_ = BetweenRows(turning);
    const Rows<3> mean = BetweenRows(nu);
    for (Eigen::Index k = half_width_; k + half_width_ < n; ++k) {
      const Eigen::RowVector3d smoothed =
          kernel.transpose() * mean.middleRows(k - half_width_, kernel.size());
      Write({smoothed[0], smoothed[1], smoothed[2]}, k, filtered_surge_, filtered_turning_);
    }
  }

  /// int phi (F Phi - Phi(F .)) dt of the window that begins at this row of the part.
  Eigen::RowVectorXd FilteringLossFrom(Eigen::Index first, bool surge,
                                       const Eigen::VectorXd& smoothed,
                                       const Eigen::VectorXd& phi) const {
    const Eigen::Index interval = first - half_width_;
    if (surge) return FilteringLossAt(surge_, filtered_surge_, smoothed, phi, interval, first);
    return FilteringLossAt(turning_, filtered_turning_, smoothed, phi, interval, first);
  }

 private:
  static Eigen::Index Count(const RowRange& part) { return static_cast<Eigen::Index>(part.size()); }

  static void Write(const Nu& nu, Eigen::Index row, Rows<5>& surge, Rows<9>& turning) {
    const BodyRow body = BodyRowAt(nu);
    std::ranges::copy(body.surge, surge.row(row).data());
    std::ranges::copy(body.turning, turning.row(row).data());
  }

  Rows<5> surge_;
  Rows<9> turning_;
  Rows<5> filtered_surge_;
  Rows<9> filtered_turning_;
  Eigen::Index half_width_;
};

Instruments::Instruments(const PreparedDataset& dataset, const WeakProblem& problem)
    : dataset_(dataset),
      problem_(problem),
      fastest_(FastestOf(dataset)),
      kernel_(FilterOnIntervals(dataset)),
      smoothed_phi_(FilteredTestFunction(kernel_, problem.phi)) {
  const double h = dataset.sampling_period_s;
  restart_rows_ =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kRestartPeriodS / h)));
  // Beyond what the windows themselves need, which the filter widens.
  lead_in_rows_ = std::max(problem.phi.Rows() / 2 + 1, dataset.options.smoothing_half_width);
}

std::array<PredictedSupports, 3> Instruments::Predict(
    const VesselModel& model, const std::vector<ConstantDisturbance>& disturbance_terms,
    const std::array<std::vector<std::size_t>, 3>& columns, const FilteredThrust& thrust) const {
  const BodyDynamics dynamics(model);
  std::array<bool, 3> simulated{};
  std::ranges::transform(columns, simulated.begin(), [](const auto& of) { return !of.empty(); });
  const std::array<std::size_t, 3> projected_as = SharedProjections(problem_, simulated);
  std::array<PredictedSupports, 3> whole;  // of every column, sought or not
  for (std::size_t j = 0; j < whole.size(); ++j) {
    if (!simulated[j] || projected_as[j] != j) continue;
    const auto supports = std::ssize(problem_.supports[j].first_rows);
    whole[j].Z.resize(supports, ColumnsOf(problem_, kEquations[j]));
    whole[j].filtering_loss = Eigen::MatrixXd::Zero(supports, whole[j].Z.cols());
  }
  std::vector<Instant> predicted(dataset_.rows.size());
  for (const Part& part : Parts()) {
    Simulate(dynamics, disturbance_terms[part.recording], simulated, thrust, part, predicted);
    const Bodies bodies(predicted, part.rows, kernel_);
    for (std::size_t j = 0; j < whole.size(); ++j) {
      if (whole[j].Z.size() > 0) ProjectPart(j, thrust, predicted, part, bodies, whole[j]);
    }
  }
  std::array<PredictedSupports, 3> sought;
  for (std::size_t j = 0; j < sought.size(); ++j) {
    if (!simulated[j]) continue;
    const PredictedSupports& supports = whole[projected_as[j]];
    sought[j] = {supports.Z(Eigen::all, columns[j]),
                 supports.filtering_loss(Eigen::all, columns[j])};
  }
  return sought;
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

void Instruments::Simulate(const BodyDynamics& dynamics,
                           const ConstantDisturbance& disturbance_terms,
                           const std::array<bool, 3>& simulated, const FilteredThrust& thrust,
                           const Part& part, std::vector<Instant>& predicted) const {
  const double h = dataset_.sampling_period_s;
  const PreparedRow& start = dataset_.rows[part.rows.begin];
  predicted[part.rows.begin] = {start.nu, start.eta.psi_rad};
  const Nu limits = kInstrumentDivergence.LimitsFor(fastest_);
  for (std::size_t k = part.rows.begin; k + 1 < part.rows.end; ++k) {
    const NuDot propelled = dynamics.Propelled(thrust.interval[k]);
    const NuDot constant = disturbance_terms.At(predicted[k].psi_rad);
    const Nu next = dynamics.Step(
        {propelled.u + constant.u, propelled.v + constant.v, propelled.r + constant.r},
        predicted[k].nu, h);
    const Nu& measured = dataset_.rows[k + 1].nu;
    Instant& then = predicted[k + 1];
    then.nu = {simulated[0] ? Clamped(next.u, limits.u) : measured.u,
               simulated[1] ? Clamped(next.v, limits.v) : measured.v,
               simulated[2] ? Clamped(next.r, limits.r) : measured.r};
    then.psi_rad = predicted[k].psi_rad + h * (predicted[k].nu.r + then.nu.r) / 2.0;
  }
}

void Instruments::ProjectPart(std::size_t equation, const FilteredThrust& thrust,
                              const std::vector<Instant>& predicted, const Part& part,
                              const Bodies& bodies, PredictedSupports& supports) const {
  const auto& first_rows = problem_.supports[equation].first_rows;
  const std::size_t half = problem_.phi.Rows() / 2;
  const Equation name = kEquations[equation];
  const std::size_t disturbance_terms = problem_.disturbance_terms.Count();
  const std::size_t regressors = static_cast<std::size_t>(supports.Z.cols()) - disturbance_terms;
  RegressorRows phi(static_cast<Eigen::Index>(part.rows.size()), supports.Z.cols());
  for (std::size_t k = part.rows.begin; k < part.rows.end; ++k) {
    double* const row = phi.row(static_cast<Eigen::Index>(k - part.rows.begin)).data();
    FillRow(name, predicted[k].nu, thrust.filtered[k], {row, regressors});
    problem_.disturbance_terms.Fill(part.recording, predicted[k].psi_rad,
                                    {row + regressors, disturbance_terms});
  }
  const Eigen::VectorXd& weights = problem_.phi.value;
  const std::size_t first_centred = part.centres.begin - std::min(part.centres.begin, half);
  Eigen::RowVectorXd sum(phi.cols());
  for (auto at = std::ranges::lower_bound(first_rows, first_centred);
       at != first_rows.end() && *at + half < part.centres.end; ++at) {
    if (*at + half < part.centres.begin) continue;
    const auto first = static_cast<Eigen::Index>(*at - part.rows.begin);
    sum.noalias() = weights.transpose() * phi.middleRows(first, weights.size());
    const Eigen::RowVectorXd filtering_loss =
        bodies.FilteringLossFrom(first, name == Equation::kSurge, smoothed_phi_, weights);
    const auto support = static_cast<Eigen::Index>(at - first_rows.begin());
    supports.Z.row(support) = sum;
    supports.filtering_loss.row(support).head(filtering_loss.size()) = filtering_loss;
  }
}

}  // namespace telltale
