#include "telltale/core/drift/commanded_error_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr std::size_t kSpan = std::ranges::min(kDrift.spans);
// Of the runs in a span. Fewer tell neither that errors follow the commands nor that they do not.
constexpr std::size_t kLeastRuns = kSpan * kDrift.block_windows / 2;

using Runs = std::vector<const RunError*>;

struct Fit {
  double squares = 0.0;   ///< of what it leaves
  Eigen::Index rank = 0;  ///< of its columns
};

Fit LeastSquares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::VectorXd coefficients = qr.solve(y);
  return {(y - columns * coefficients).squaredNorm(), qr.rank()};
}

/// The share of the squares of `y` that the last columns explain beside the first ones, less what
/// as many columns explain by chance; zero where the F-test does not tell it from chance.
double ExplainedShare(const Eigen::MatrixXd& columns, Eigen::Index first,
                      const Eigen::VectorXd& y) {
  const Fit without = LeastSquares(columns.leftCols(first), y);
  const Fit with = LeastSquares(columns, y);
  const auto terms = static_cast<double>(with.rank - without.rank);
  const auto freedom = static_cast<double>(y.size() - with.rank);
  if (terms < 1.0 || freedom < 1.0 || with.squares <= 0.0) return 0.0;
  const double variance = with.squares / freedom;
  const double explained = without.squares - with.squares;
  if (FisherTail(terms, freedom, explained / terms / variance) > kDrift.chance) return 0.0;
  return (explained - terms * variance) / y.squaredNorm();
}

double MeanSquare(const Runs& runs, std::size_t velocity) {
  double sum = 0.0;
  for (const RunError* run : runs) sum += run->square[velocity];
  return sum / static_cast<double>(runs.size());
}

/// Runs by what weather and the commands do: one row each.
Eigen::MatrixXd ColumnsOf(const Runs& runs) {
  const Eigen::Index weather = runs.front()->weather.size();
  Eigen::MatrixXd columns(runs.size(), weather + runs.front()->commanded.size());
  for (Eigen::Index k = 0; k < columns.rows(); ++k) {
    const RunError& run = *runs[static_cast<std::size_t>(k)];
    columns.row(k) << run.weather.transpose(), run.commanded.transpose();
  }
  return columns;
}

Eigen::VectorXd MeanErrors(const Runs& runs, std::size_t velocity) {
  Eigen::VectorXd errors(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    errors[static_cast<Eigen::Index>(k)] = runs[k]->mean[velocity];
  }
  return errors;
}

Runs RunsOf(const std::deque<std::vector<RunError>>& blocks,
            const std::vector<RunError>* left_out) {
  Runs runs;
  for (const std::vector<RunError>& block : blocks) {
    if (&block == left_out) continue;
    for (const RunError& run : block) runs.push_back(&run);
  }
  return runs;
}

}  // namespace

/// Whether enough runs hold commands that vary.
bool CommandedErrorTest::CanTell() const {
  const Runs runs = RunsOf(blocks_, nullptr);
  if (runs.size() < kLeastRuns) return false;
  const auto varies = [&](double PropellerCommand::*side) {
    const auto of = [side](const RunError* run) { return run->command.*side; };
    const auto [least, most] = std::ranges::minmax(runs, {}, of);
    return of(most) - of(least) >= kDrift.least_command_range;
  };
  return varies(&PropellerCommand::port) || varies(&PropellerCommand::starboard);
}

/// The explained error of all blocks but one; of all where that is null.
double CommandedErrorTest::ExplainedWithout(const std::vector<RunError>* left_out) const {
  const Runs runs = RunsOf(blocks_, left_out);
  if (runs.empty()) return 0.0;
  const Eigen::MatrixXd columns = ColumnsOf(runs);
  const Eigen::Index weather = runs.front()->weather.size();
  double sum = 0.0;
  for (std::size_t i = 0; i < normal_.size(); ++i) {
    const double share = ExplainedShare(columns, weather, MeanErrors(runs, i));
    sum += share * MeanSquare(runs, i) / (normal_[i] * normal_[i]);
  }
  return std::sqrt(sum / static_cast<double>(normal_.size()));
}

bool CommandedErrorTest::IsBeyondDoubt() const {
  return Rises() && std::ranges::all_of(blocks_, [&](const std::vector<RunError>& block) {
           return ExplainedWithout(&block) > kDrift.tolerated_error;
         });
}

void CommandedErrorTest::Add(std::vector<RunError> block) {
  blocks_.push_back(std::move(block));
  if (blocks_.size() > kSpan) blocks_.pop_front();
  if (blocks_.size() < kSpan || !CanTell()) return;
  explained_ = ExplainedWithout(nullptr);
  fires_ = IsBeyondDoubt() || (fires_ && Rises());
}

}  // namespace telltale
