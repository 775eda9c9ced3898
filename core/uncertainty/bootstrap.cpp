#include "telltale/core/uncertainty/bootstrap.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include <Eigen/Core>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/uncertainty/block_length.hpp"
#include "telltale/core/uncertainty/packed_normal_equations.hpp"
#include "telltale/core/uncertainty/resampling_units.hpp"
#include "telltale/core/uncertainty/timeline.hpp"

namespace telltale {
namespace {

// The sums of a batch of replicates stay in a second-level cache of this size.
constexpr std::size_t kBatchBytes = 512 * 1024;

/// Which replicates of a batch drew each unit: those of unit u are replicates[first[u]] up to
/// first[u + 1], ascending, one entry each time it was drawn.
struct Draws {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> replicates;
};

Draws Draw(const DrawPlan& plan, std::uint64_t seed, const RowRange& batch) {
  std::vector<std::uint32_t> drawn;
  drawn.reserve(batch.size() * plan.draws);
  Draws draws;
  draws.first.assign(plan.units + 1, 0);
  for (std::size_t i = batch.begin; i < batch.end; ++i) {
    RandomEngine engine = RandomEngine::Stream(seed, i);
    for (std::size_t draw = 0; draw < plan.draws; ++draw) {
      drawn.push_back(plan.tickets[DrawBelow(engine, plan.tickets.size())]);
      ++draws.first[drawn.back() + 1];
    }
  }
  std::partial_sum(draws.first.begin(), draws.first.end(), draws.first.begin());
  std::vector<std::uint32_t> next(draws.first.begin(), draws.first.end() - 1);
  draws.replicates.resize(drawn.size());
  auto unit = drawn.begin();
  for (std::uint32_t replicate = 0; replicate < batch.size(); ++replicate) {
    for (std::size_t draw = 0; draw < plan.draws; ++draw) {
      draws.replicates[next[*unit++]++] = replicate;
    }
  }
  return draws;
}

/// visit(unit, replicate, times) for every replicate that drew the unit.
template <class Units, class Visit>
void ForEachDrawn(const Units& units, const Draws& draws, const Visit& visit) {
  units.ForEach([&](const Unit& unit) {
    const std::uint32_t end = draws.first[unit.index + 1];
    for (std::uint32_t k = draws.first[unit.index]; k < end;) {
      const std::uint32_t replicate = draws.replicates[k];
      double times = 0.0;
      for (; k < end && draws.replicates[k] == replicate; ++k) times += 1.0;
      visit(unit, static_cast<Eigen::Index>(replicate), times);
    }
  });
}

Eigen::MatrixXd Unpacked(const double* system, Eigen::Index r) {
  Eigen::MatrixXd lower(r, r);
  for (Eigen::Index j = 0; j < r; ++j) {
    lower.col(j).tail(r - j) = Eigen::Map<const Eigen::VectorXd>(system, r - j);
    system += r - j + 1;
  }
  return lower;
}

/// Standard errors from the sandwich B A^-1 M A^-1 B', given A^-1 B' and packed M = sum q q'.
Eigen::VectorXd SandwichErrors(const Eigen::MatrixXd& bread, const double* scores) {
  const Eigen::MatrixXd M = Unpacked(scores, bread.rows());
  const Eigen::MatrixXd half = M.selfadjointView<Eigen::Lower>() * bread;
  return half.cwiseProduct(bread).colwise().sum().cwiseMax(0.0).cwiseSqrt().transpose();
}

/// The replicates of one batch for one fit.
class BatchFit {
 public:
  BatchFit(const ClusteredFit& fit, Eigen::Index count)
      : fit_(fit),
        r_(fit.W.cols()),
        sums_(Eigen::MatrixXd::Zero(Length(), count)),
        x_(Eigen::MatrixXd::Zero(r_, count)),
        solved_(static_cast<std::size_t>(count), 0) {}

  template <class Units>
  void Solve(const Units& units, const Draws& draws) {
    ForEachDrawn(units, draws, [&](const Unit& unit, Eigen::Index i, double times) {
      AddSystem(unit.system, Unknowns(), times, sums_.col(i).data());
    });
    for (Eigen::Index i = 0; i < x_.cols(); ++i) {
      if (!Factorise(Unknowns(), sums_.col(i).data())) continue;
      Substitute(sums_.col(i).data(), Unknowns(), x_.col(i).data());
      solved_[static_cast<std::size_t>(i)] = 1;
    }
  }

  bool Solved(Eigen::Index i) const { return solved_[static_cast<std::size_t>(i)] != 0; }

  Eigen::VectorXd Theta(Eigen::Index i) const { return fit_.theta + fit_.basis * x_.col(i); }

  /// Shapes: p x count.
  template <class Units>
  Eigen::MatrixXd StandardErrors(const Units& units, const Draws& draws) const {
    Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(sums_.rows(), sums_.cols());
    std::vector<double> score(Unknowns() + 1, 0.0);
    ForEachDrawn(units, draws, [&](const Unit& unit, Eigen::Index i, double times) {
      ScoreAt(unit.system, Unknowns(), x_.col(i).data(), score.data());
      AddRow(score.data(), Unknowns(), times, scores.col(i).data());
    });
    Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(fit_.theta.size(), sums_.cols());
    for (Eigen::Index i = 0; i < sums_.cols(); ++i) {
      if (!Solved(i)) continue;
      const Eigen::MatrixXd L = Unpacked(sums_.col(i).data(), r_);
      Eigen::MatrixXd bread = fit_.basis.transpose();
      L.triangularView<Eigen::Lower>().solveInPlace(bread);
      L.triangularView<Eigen::Lower>().transpose().solveInPlace(bread);
      errors.col(i) = SandwichErrors(bread, scores.col(i).data());
    }
    return errors;
  }

 private:
  std::size_t Unknowns() const { return static_cast<std::size_t>(r_); }
  Eigen::Index Length() const { return static_cast<Eigen::Index>(PackedLength(Unknowns())); }

  const ClusteredFit& fit_;
  Eigen::Index r_;
  Eigen::MatrixXd sums_;  // normal equations, then their Cholesky factors
  Eigen::MatrixXd x_;
  std::vector<char> solved_;
};

/// Standard errors of the estimate itself, as those of a replicate that drew every unit as often as
/// it is drawn on average.
template <class Units>
Eigen::VectorXd StandardErrors(const ClusteredFit& fit, const Units& units, const DrawPlan& plan) {
  const auto r = static_cast<std::size_t>(fit.W.cols());
  const std::vector<double> at_estimate(r, 0.0);
  std::vector<double> score(r + 1, 0.0);
  std::vector<double> scores(PackedLength(r), 0.0);
  const double draws_per_ticket =
      static_cast<double>(plan.draws) / static_cast<double>(plan.tickets.size());
  units.ForEach([&](const Unit& unit) {
    ScoreAt(unit.system, r, at_estimate.data(), score.data());
    AddRow(score.data(), r, unit.tickets * draws_per_ticket, scores.data());
  });
  return SandwichErrors(fit.basis.transpose(), scores.data());
}

/// The acceleration of every coefficient; units without which the rest cannot be solved are passed
/// over.
template <class Units>
Eigen::VectorXd Accelerations(const ClusteredFit& fit, const Units& units) {
  const auto r = static_cast<std::size_t>(fit.W.cols());
  std::vector<std::vector<double>> left_out(static_cast<std::size_t>(fit.theta.size()));
  Eigen::VectorXd x(fit.W.cols());
  units.ForEach([&](const Unit& unit) {
    if (!unit.tile) return;
    std::vector<double> rest(PackedLength(r), 0.0);
    for (std::size_t j = 0, diagonal = 0; j < r; diagonal += r - j + 1, ++j) rest[diagonal] = 1.0;
    AddSystem(unit.system, r, -1.0, rest.data());
    if (!Factorise(r, rest.data())) return;
    Substitute(rest.data(), r, x.data());
    const Eigen::VectorXd change = fit.basis * x;
    for (std::size_t j = 0; j < left_out.size(); ++j) {
      left_out[j].push_back(change[static_cast<Eigen::Index>(j)]);
    }
  });
  Eigen::VectorXd accelerations(fit.theta.size());
  for (std::size_t j = 0; j < left_out.size(); ++j) {
    accelerations[static_cast<Eigen::Index>(j)] = JackknifeAcceleration(left_out[j]);
  }
  return accelerations;
}

Eigen::VectorXd StackedTheta(const std::vector<ClusteredFit>& fits) {
  Eigen::VectorXd stacked(0);
  for (const ClusteredFit& fit : fits) {
    stacked.conservativeResize(stacked.size() + fit.theta.size());
    stacked.tail(fit.theta.size()) = fit.theta;
  }
  return stacked;
}

std::size_t BatchSize(const std::vector<ClusteredFit>& fits, const BootstrapOptions& options) {
  std::size_t longest = 1;
  for (const ClusteredFit& fit : fits) {
    longest = std::max(longest, PackedLength(static_cast<std::size_t>(fit.W.cols())));
  }
  const std::size_t fitting = std::max<std::size_t>(1, kBatchBytes / (longest * sizeof(double)));
  const std::size_t share = (options.replicates + options.threads - 1) / options.threads;
  return std::min(fitting, share);
}

/// Keeps the columns that were solved, in order.
void KeepSolved(const std::vector<char>& solved, Eigen::MatrixXd& columns) {
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    if (!solved[static_cast<std::size_t>(i)]) continue;
    if (kept != i) columns.col(kept) = columns.col(i);
    ++kept;
  }
  columns.conservativeResize(Eigen::NoChange, kept);
}

/// Solves one batch of replicates for every fit and writes it into its columns.
template <class Units>
void ReplicateBatch(const std::vector<ClusteredFit>& fits, const std::vector<Units>& units,
                    const Draws& draws, const RowRange& batch, std::vector<char>& solved,
                    BootstrapReplicates& replicates) {
  const auto begin = static_cast<Eigen::Index>(batch.begin);
  const auto count = static_cast<Eigen::Index>(batch.size());
  Eigen::Index first = 0;
  for (std::size_t f = 0; f < fits.size(); ++f) {
    const Eigen::Index p = fits[f].theta.size();
    BatchFit fit(fits[f], count);
    fit.Solve(units[f], draws);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!fit.Solved(i)) solved[batch.begin + static_cast<std::size_t>(i)] = 0;
      replicates.theta.col(begin + i).segment(first, p) = fit.Theta(i);
    }
    if (replicates.standard_errors.size() > 0) {
      replicates.standard_errors.block(first, begin, p, count) =
          fit.StandardErrors(units[f], draws);
    }
    first += p;
  }
}

/// What the interval asked for needs to know of the estimate itself.
template <class Units>
void QuantifyEstimate(const std::vector<ClusteredFit>& fits, const std::vector<Units>& units,
                      const DrawPlan& plan, IntervalMethod interval,
                      BootstrapReplicates& replicates) {
  const bool studentized = interval == IntervalMethod::kStudentized;
  const bool accelerated = interval == IntervalMethod::kBca;
  if (studentized) replicates.standard_error.resize(replicates.estimate.size());
  if (accelerated) replicates.acceleration.resize(replicates.estimate.size());
  Eigen::Index first = 0;
  for (std::size_t f = 0; f < fits.size(); ++f) {
    const Eigen::Index p = fits[f].theta.size();
    if (studentized) {
      replicates.standard_error.segment(first, p) = StandardErrors(fits[f], units[f], plan);
    }
    if (accelerated) replicates.acceleration.segment(first, p) = Accelerations(fits[f], units[f]);
    first += p;
  }
}

template <class Units>
BootstrapReplicates Replicate(const std::vector<ClusteredFit>& fits,
                              const std::vector<Units>& units, const DrawPlan& plan,
                              const BootstrapOptions& options) {
  BootstrapReplicates replicates;
  replicates.estimate = StackedTheta(fits);
  replicates.draws = plan.draws;
  const Eigen::Index p = replicates.estimate.size();
  const auto columns = static_cast<Eigen::Index>(options.replicates);
  replicates.theta.resize(p, columns);
  if (options.interval == IntervalMethod::kStudentized) {
    replicates.standard_errors.resize(p, columns);
  }

  std::vector<char> solved(options.replicates, 1);
  const std::size_t size = BatchSize(fits, options);
  ForEachIndex((options.replicates + size - 1) / size, options.threads, [&](std::size_t b) {
    const RowRange batch{b * size, std::min((b + 1) * size, options.replicates)};
    ReplicateBatch(fits, units, Draw(plan, options.seed, batch), batch, solved, replicates);
  });
  KeepSolved(solved, replicates.theta);
  if (replicates.standard_errors.size() > 0) KeepSolved(solved, replicates.standard_errors);
  replicates.failures = options.replicates - static_cast<std::size_t>(replicates.theta.cols());
  QuantifyEstimate(fits, units, plan, options.interval, replicates);
  return replicates;
}

BootstrapReplicates BootstrapSegments(const std::vector<ClusteredFit>& fits,
                                      const BootstrapOptions& options) {
  const std::size_t slices = fits.front().clusters.size();
  std::vector<SliceUnits> units;
  for (const ClusteredFit& fit : fits) {
    Require(fit.clusters.size() == slices, "the same slices in every fit");
    units.emplace_back(fit);
  }
  return Replicate(fits, units, PlanSlices(slices), options);
}

std::size_t LengthFromData(const std::vector<ClusteredFit>& fits, const Timeline& timeline) {
  Eigen::MatrixXd influence(static_cast<Eigen::Index>(timeline.instants.size()), 0);
  for (const ClusteredFit& fit : fits) {
    const Eigen::Index p = fit.theta.size();
    influence.conservativeResize(Eigen::NoChange, influence.cols() + p);
    influence.rightCols(p) = InfluenceAlong(timeline, fit);
  }
  return BlockLength(influence, timeline.runs);
}

BootstrapReplicates BootstrapBlocks(const std::vector<ClusteredFit>& fits,
                                    const BootstrapOptions& options) {
  const Timeline timeline = TimelineOf(fits);
  const std::size_t length =
      options.block_length > 0 ? options.block_length : LengthFromData(fits, timeline);
  std::vector<BlockUnits> units;
  for (const ClusteredFit& fit : fits) units.emplace_back(fit, timeline, length);
  BootstrapReplicates replicates = Replicate(fits, units, PlanBlocks(timeline, length), options);
  replicates.block_length = length;
  return replicates;
}

}  // namespace

std::string_view Name(Resampling resampling) {
  switch (resampling) {
    case Resampling::kSlices: return "SEGMENTS";
    case Resampling::kMovingBlocks: return "MOVING_BLOCKS";
    case Resampling::kParametric: return "PARAMETRIC";
    case Resampling::kUnknown: break;
  }
  return "UNKNOWN";
}

BootstrapReplicates Bootstrap(const std::vector<ClusteredFit>& fits,
                              const BootstrapOptions& options) {
  Require(!fits.empty(), "at least one fit");
  Require(options.resampling != Resampling::kUnknown, "a kind of resampling");
  return options.resampling == Resampling::kMovingBlocks ? BootstrapBlocks(fits, options)
                                                         : BootstrapSegments(fits, options);
}

Eigen::MatrixXd Covariance(const BootstrapReplicates& replicates) {
  Require(replicates.theta.cols() > 1, "at least two replicates");
  return OfColumns(replicates.theta);
}

std::vector<Interval> Intervals(const BootstrapReplicates& replicates, IntervalMethod method,
                                double level) {
  const auto view = [](const Eigen::VectorXd& row) {
    return std::span(row.data(), static_cast<std::size_t>(row.size()));
  };
  std::vector<Interval> intervals;
  for (Eigen::Index j = 0; j < replicates.theta.rows(); ++j) {
    const Eigen::VectorXd theta = replicates.theta.row(j);
    const double estimate = replicates.estimate[j];
    switch (method) {
      case IntervalMethod::kPercentile:
        intervals.push_back(PercentileInterval(view(theta), level));
        break;
      case IntervalMethod::kBca:
        Require(replicates.acceleration.size() > 0, "replicates drawn for BCa");
        intervals.push_back(BcaInterval(estimate, replicates.acceleration[j], view(theta), level));
        break;
      case IntervalMethod::kStudentized: {
        Require(replicates.standard_error.size() > 0, "replicates drawn for studentizing");
        const Eigen::VectorXd errors = replicates.standard_errors.row(j);
        const bool known = errors.minCoeff() > 0.0;
        intervals.push_back(known ? StudentizedInterval(estimate, replicates.standard_error[j],
                                                        view(theta), view(errors), level)
                                  : Unbounded(level));
        break;
      }
      case IntervalMethod::kUnknown: Require(false, "a method of intervals");
    }
  }
  return intervals;
}

}  // namespace telltale
