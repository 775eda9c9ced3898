#include "telltale/core/uncertainty/resampling_units.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>
#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// A fit of two unknowns with a row at each of these instants; W is not orthonormal, which no sum
/// minds.
ClusteredFit FitAt(const std::vector<std::size_t>& instants) {
  RandomEngine engine(11);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  ClusteredFit fit;
  fit.W.resize(static_cast<Eigen::Index>(instants.size()), 2);
  for (double& value : fit.W.reshaped()) value = normal(engine);
  fit.residual = fit.W.rowwise().sum().array().sin();
  fit.theta = Eigen::VectorXd::Zero(2);
  fit.basis = Eigen::MatrixXd::Identity(2, 2);
  fit.instants = instants;
  return fit;
}

/// Runs of 10, 3 and 5 instants.
std::vector<std::size_t> GappyInstants() {
  std::vector<std::size_t> instants(10);
  std::iota(instants.begin(), instants.end(), std::size_t{100});
  for (const std::size_t instant : {112u, 113u, 114u, 120u, 121u, 122u, 123u, 124u}) {
    instants.push_back(instant);
  }
  return instants;
}

std::vector<double> SumOfRows(const ClusteredFit& fit, const std::vector<std::size_t>& instants) {
  std::vector<double> sum(PackedLength(2), 0.0);
  for (const std::size_t instant : instants) {
    for (std::size_t i = 0; i < fit.instants.size(); ++i) {
      if (fit.instants[i] != instant) continue;
      const auto row = static_cast<Eigen::Index>(i);
      const double numbers[] = {fit.W(row, 0), fit.W(row, 1), fit.residual[row]};
      AddRow(numbers, 2, 1.0, sum.data());
    }
  }
  return sum;
}

TEST(Timeline, EndsARunAtEveryHole) {
  const Timeline timeline = TimelineOf({FitAt(GappyInstants())});
  ASSERT_EQ(timeline.runs.size(), 3u);
  EXPECT_EQ(timeline.runs[0].size(), 10u);
  EXPECT_EQ(timeline.runs[1].size(), 3u);
  EXPECT_EQ(timeline.runs[2].size(), 5u);
}

TEST(Timeline, JoinsTheInstantsOfAllFits) {
  const Timeline timeline = TimelineOf({FitAt({5, 6, 9}), FitAt({7, 8, 20})});
  EXPECT_EQ(timeline.instants, (std::vector<std::size_t>{5, 6, 7, 8, 9, 20}));
  ASSERT_EQ(timeline.runs.size(), 2u);
  EXPECT_EQ(timeline.runs[0].size(), 5u);
}

TEST(PlanBlocks, DrawsEachInstantOnceOnAverage) {
  for (const std::size_t length : {1u, 3u, 4u, 9u, 10u, 30u}) {
    const ClusteredFit fit = FitAt(GappyInstants());
    const Timeline timeline = TimelineOf({fit});
    const DrawPlan plan = PlanBlocks(timeline, length);
    std::vector<double> weighted(PackedLength(2), 0.0);
    std::size_t units = 0;
    double tickets = 0.0;
    BlockUnits(fit, timeline, length).ForEach([&](const Unit& unit) {
      EXPECT_EQ(unit.index, units++);
      EXPECT_EQ(std::count(plan.tickets.begin(), plan.tickets.end(), unit.index), unit.tickets);
      AddSystem(unit.system, 2, unit.tickets, weighted.data());
      tickets += unit.tickets;
    });
    EXPECT_EQ(units, plan.units);
    EXPECT_EQ(tickets, static_cast<double>(plan.tickets.size()));
    const std::vector<double> all = SumOfRows(fit, fit.instants);
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_NEAR(weighted[k], static_cast<double>(length) * all[k], 1e-10) << "length " << length;
    }
    const double draws = tickets / static_cast<double>(length);
    EXPECT_NEAR(static_cast<double>(plan.draws), std::max(draws, 1.0), 0.5 + 1e-12);
  }
}

/// Length 4: the run of ten gives ten circular blocks, the run of three itself, the run of five
/// five.
TEST(BlockUnits, AreTheSumsOfTheirRowsAndStraddleNoGap) {
  const ClusteredFit fit = FitAt(GappyInstants());
  const Timeline timeline = TimelineOf({fit});
  std::vector<std::vector<std::size_t>> blocks;
  for (std::size_t start = 0; start < 10; ++start) {
    blocks.push_back(
        {100 + start, 100 + (start + 1) % 10, 100 + (start + 2) % 10, 100 + (start + 3) % 10});
  }
  blocks.push_back({112, 113, 114});
  for (std::size_t start = 0; start < 5; ++start) {
    blocks.push_back(
        {120 + start, 120 + (start + 1) % 5, 120 + (start + 2) % 5, 120 + (start + 3) % 5});
  }
  std::size_t visited = 0;
  std::vector<std::size_t> tiles;
  BlockUnits(fit, timeline, 4).ForEach([&](const Unit& unit) {
    ASSERT_LT(unit.index, blocks.size());
    const std::vector<double> direct = SumOfRows(fit, blocks[unit.index]);
    for (std::size_t k = 0; k < direct.size(); ++k) EXPECT_NEAR(unit.system[k], direct[k], 1e-12);
    if (unit.tile) tiles.push_back(unit.index);
    ++visited;
  });
  EXPECT_EQ(visited, blocks.size());
  EXPECT_EQ(tiles, (std::vector<std::size_t>{0, 4, 10, 11}));
}

/// Rows stacked equation by equation, as a joint fit has them, share their instants.
TEST(BlockUnits, TakeAllRowsOfAnInstant) {
  const ClusteredFit fit = FitAt({7, 8, 9, 10, 7, 8, 9, 10});
  const Timeline timeline = TimelineOf({fit});
  ASSERT_EQ(timeline.instants.size(), 4u);
  BlockUnits(fit, timeline, 2).ForEach([&](const Unit& unit) {
    const std::vector<double> direct = SumOfRows(fit, {7 + unit.index, 7 + (unit.index + 1) % 4});
    for (std::size_t k = 0; k < direct.size(); ++k) EXPECT_NEAR(unit.system[k], direct[k], 1e-12);
  });
}

}  // namespace
}  // namespace telltale
