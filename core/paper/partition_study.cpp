#include "telltale/core/paper/partition_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <boost/random/uniform_int_distribution.hpp>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/base/range.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/paper/redundant_least_squares.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {
namespace {

constexpr std::size_t kFewestSlices = 10;

/// Items drawn at random for training and for validation.
struct RowPartition {
  std::vector<std::size_t> training;
  std::vector<std::size_t> validation;
};

std::vector<std::size_t> Shuffled(std::size_t count, RandomEngine& engine) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    boost::random::uniform_int_distribution<std::size_t> pick(0, i - 1);
    std::swap(order[i - 1], order[pick(engine)]);
  }
  return order;
}

/// Draws both sets; each takes items until it has its share of the rows. Validation items come
/// first, so that a seed gives the same validation items for every training share.
RowPartition DrawPartition(const std::vector<std::size_t>& rows_of, const PartitionOptions& options,
                           RandomEngine engine) {
  const auto total =
      static_cast<double>(std::accumulate(rows_of.begin(), rows_of.end(), std::size_t{0}));
  RowPartition partition;
  double validation = 0.0;
  double training = 0.0;
  for (const std::size_t item : Shuffled(rows_of.size(), engine)) {
    const auto rows = static_cast<double>(rows_of[item]);
    if (validation < options.validation_share * total) {
      partition.validation.push_back(item);
      validation += rows;
    } else if (training < options.training_share * total) {
      partition.training.push_back(item);
      training += rows;
    }
  }
  return partition;
}

std::vector<Eigen::Index> RowsOf(const EquationProblem& problem,
                                 const std::vector<std::size_t>& slices) {
  std::vector<Eigen::Index> rows;
  for (const std::size_t slice : slices) {
    const RowRange& range = problem.clusters[slice];
    for (std::size_t k = range.begin; k < range.end; ++k) {
      rows.push_back(static_cast<Eigen::Index>(k));
    }
  }
  return rows;
}

std::vector<Eigen::Index> AsRows(const std::vector<std::size_t>& points) {
  return {points.begin(), points.end()};
}

Eigen::VectorXd Fit(const EquationProblem& problem, const std::vector<Eigen::Index>& rows) {
  Eigen::MatrixXd phi = problem.phi(rows, Eigen::all);
  const Eigen::VectorXd norms =
      phi.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  phi *= norms.cwiseInverse().asDiagonal();
  const TriangularFactor factor = Triangularise(phi, problem.y(rows));
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(factor.R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.solve(factor.z).cwiseQuotient(norms);
}

struct Score {
  double mae = 0.0;
  double r2 = 0.0;
  double constant_velocity_r2 = 0.0;
};

/// Equations (16) and (17) on nu(k+1) = nu(k) + h y(k).
Score ScoreRows(const EquationProblem& problem, double h, const Eigen::VectorXd& theta,
                const std::vector<Eigen::Index>& rows) {
  const Eigen::VectorXd step = h * problem.y(rows);
  const Eigen::VectorXd next = Eigen::VectorXd(problem.nu(rows)) + step;
  const Eigen::VectorXd error = step - h * (problem.phi(rows, Eigen::all) * theta);
  const double spread = (next.array() - next.mean()).square().sum();
  return {error.cwiseAbs().mean(), 1.0 - error.squaredNorm() / spread,
          1.0 - step.squaredNorm() / spread};
}

Spread SpreadOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0};
}

/// The scores of one velocity under one partition.
struct Sample {
  Score training;
  Score validation;
  std::optional<FreeRunScore> free_run;
};

template <class Value>
Spread SpreadOver(const std::vector<std::array<Sample, 3>>& samples, std::size_t j,
                  const Value& value) {
  std::vector<double> values;
  for (const auto& sample : samples) values.push_back(value(sample[j]));
  return SpreadOf(values);
}

PartitionScores Summarise(const std::vector<std::array<Sample, 3>>& samples, std::size_t j) {
  const auto spread = [&](const auto& value) { return SpreadOver(samples, j, value); };
  PartitionScores scores;
  scores.training_mae = spread([](const Sample& s) { return s.training.mae; });
  scores.training_r2 = spread([](const Sample& s) { return s.training.r2; });
  scores.mae = spread([](const Sample& s) { return s.validation.mae; });
  scores.r2 = spread([](const Sample& s) { return s.validation.r2; });
  scores.constant_velocity_r2 =
      spread([](const Sample& s) { return s.validation.constant_velocity_r2; });
  const bool free = std::all_of(samples.begin(), samples.end(),
                                [&](const auto& s) { return s[j].free_run.has_value(); });
  if (!free) return scores;
  scores.free_run_rmse = spread([](const Sample& s) { return s.free_run->rmse; });
  scores.constant_velocity_free_run_rmse =
      spread([](const Sample& s) { return s.free_run->constant_velocity_rmse; });
  return scores;
}

std::array<EquationProblem, 3> BuildProblems(const PreparedDataset& dataset,
                                             const RegressionOptions& options) {
  if (options.structure == Structure::kStaticQuadratic) {
    return BuildRegression(dataset, options).equations;
  }
  return {BuildRedundant(dataset, Equation::kSurge, options),
          BuildRedundant(dataset, Equation::kSway, options),
          BuildRedundant(dataset, Equation::kYaw, options)};
}

/// The dataset with only these slices, each a segment of its own.
PreparedDataset Restrict(const PreparedDataset& dataset, const std::vector<std::size_t>& slices) {
  PreparedDataset part = dataset;
  part.slices.clear();
  for (const std::size_t slice : slices) part.slices.push_back(dataset.slices[slice]);
  std::sort(part.slices.begin(), part.slices.end(),
            [](const RowRange& a, const RowRange& b) { return a.begin < b.begin; });
  part.segments = part.slices;
  return part;
}

void RunFreely(const PreparedDataset& dataset, const RowPartition& partition,
               const PartitionOptions& options, std::array<Sample, 3>& samples) {
  const auto model = EstimateModel(Restrict(dataset, partition.training), options.regression);
  if (!model) return;
  const auto metrics =
      Validate(Restrict(dataset, partition.validation), *model, {{options.free_run_horizon_s}});
  if (!metrics || metrics->free_run.front().windows == 0) return;
  for (std::size_t j = 0; j < 3; ++j) samples[j].free_run = metrics->free_run.front().velocity[j];
}

Sample ScoreOneStep(const EquationProblem& problem, double h,
                    const std::vector<Eigen::Index>& training,
                    const std::vector<Eigen::Index>& validation) {
  const Eigen::VectorXd theta = Fit(problem, training);
  return {ScoreRows(problem, h, theta, training), ScoreRows(problem, h, theta, validation), {}};
}

std::vector<std::size_t> SegmentSizes(const PreparedDataset& dataset) {
  std::vector<std::size_t> sizes;
  for (const RowRange& slice : dataset.slices) sizes.push_back(slice.size());
  return sizes;
}

}  // namespace

std::string_view Name(PartitionMethod method) {
  switch (method) {
    case PartitionMethod::kBySlices: return "BY_SEGMENTS";
    case PartitionMethod::kByPoints: return "BY_POINTS";
    case PartitionMethod::kUnknown: break;
  }
  return "UNKNOWN";
}

std::optional<Refusal> PartitionOptions::Validate() const {
  if (auto r = OutOfRange("partition", "repeats", static_cast<double>(repeats), 1.0, 1000.0))
    return r;
  if (auto r = OutOfRange("partition", "training_share", training_share, 0.01, 0.99)) return r;
  if (auto r = OutOfRange("partition", "validation_share", validation_share, 0.01,
                          1.0 - training_share + 1e-9)) {
    return r;
  }
  if (method == PartitionMethod::kUnknown) {
    return Refusal{"partition.method", "is unset", "choose BY_SEGMENTS or BY_POINTS"};
  }
  return std::nullopt;
}

Result<std::array<PartitionScores, 3>> StudyPartitions(const PreparedDataset& dataset,
                                                       const PartitionOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*refusal);
  if (dataset.slices.size() < kFewestSlices) {
    return Refuse("partition study",
                  "only " + std::to_string(dataset.slices.size()) + " slices, " +
                      std::to_string(kFewestSlices) + " are needed",
                  "give more logs, or longer ones with more changes of manoeuvre");
  }
  const auto problems = BuildProblems(dataset, options.regression);
  const double h = dataset.sampling_period_s;
  std::vector<std::array<Sample, 3>> samples(options.repeats);
  ForEachIndex(options.repeats, options.threads, [&](std::size_t repeat) {
    const RandomEngine engine = RandomEngine::Stream(options.seed, repeat);
    if (options.method == PartitionMethod::kBySlices) {
      const RowPartition partition = DrawPartition(SegmentSizes(dataset), options, engine);
      for (std::size_t j = 0; j < 3; ++j) {
        samples[repeat][j] = ScoreOneStep(problems[j], h, RowsOf(problems[j], partition.training),
                                          RowsOf(problems[j], partition.validation));
      }
      RunFreely(dataset, partition, options, samples[repeat]);
      return;
    }
    for (std::size_t j = 0; j < 3; ++j) {
      const std::vector<std::size_t> points(static_cast<std::size_t>(problems[j].y.size()), 1);
      const RowPartition partition = DrawPartition(points, options, engine);
      samples[repeat][j] =
          ScoreOneStep(problems[j], h, AsRows(partition.training), AsRows(partition.validation));
    }
  });
  return std::array<PartitionScores, 3>{Summarise(samples, 0), Summarise(samples, 1),
                                        Summarise(samples, 2)};
}

}  // namespace telltale
