#include "telltale/core/drift/commanded_error_test.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "telltale/core/base/gauss_markov.hpp"
#include "telltale/core/drift/drift_constants.hpp"

namespace telltale {
namespace {

constexpr std::array kNormal = {0.1, 0.1, 0.1};

/// Runs of a boat that steers and changes its thrust at random, and errs as it is told.
class SteeredBoat {
 public:
  explicit SteeredBoat(std::uint64_t seed) : white_(seed, 1) {}

  /// Of a run by what it was told to do: the error of each velocity, in normal errors.
  using Error = std::function<double(const RunError&)>;

  /// A minute, in which the commands are so many times as strong as usual.
  std::vector<RunError> Block(const Error& error, double strength = 1.0) {
    std::vector<RunError> runs;
    for (std::size_t i = 0; i < kDrift.block_windows; ++i) runs.push_back(Run(error, strength));
    return runs;
  }

  /// A minute in transit.
  std::vector<RunError> Transit(const Error& error) { return Block(error, 0.0); }

  double Gust() { return white_(); }

 private:
  RunError Run(const Error& error, double strength) {
    const double psi = std::numbers::pi * white_();
    const double r = 0.2 * white_();
    RunError run;
    run.weather = Eigen::VectorXd(5);
    run.weather << 1.0, std::cos(psi), std::sin(psi), r * std::cos(psi), r * std::sin(psi);
    run.commanded = Eigen::VectorXd(9);
    for (double& term : run.commanded) term = 0.5 + strength * white_();
    run.command = {0.5 + 0.5 * strength * white_(), 0.5 + 0.5 * strength * white_()};
    for (std::size_t i = 0; i < kNormal.size(); ++i) {
      run.mean[i] = kNormal[i] * error(run);
      run.square[i] = run.mean[i] * run.mean[i];
    }
    return run;
  }

  WhiteSource white_;
};

/// Whether it fires within half an hour.
bool Fires(CommandedErrorTest& test, SteeredBoat& boat, const SteeredBoat::Error& error) {
  for (int minute = 0; minute < 30; ++minute) {
    test.Add(boat.Block(error));
    if (test.Fires()) return true;
  }
  return false;
}

TEST(CommandedErrorTest, FindsALargeErrorThatFollowsTheCommandsInAnyWeather) {
  for (const double strength : {0.1, 1.0, 3.0}) {
    SteeredBoat boat(1);
    CommandedErrorTest test(kNormal);
    const auto error = [&](const RunError& run) {
      return 8.0 * run.commanded[0] + strength * boat.Gust();
    };
    EXPECT_TRUE(Fires(test, boat, error)) << strength;
  }
}

TEST(CommandedErrorTest, FiresOnceTheSpanIsFull) {
  SteeredBoat boat(2);
  CommandedErrorTest test(kNormal);
  for (int minute = 1; minute <= 5; ++minute) {
    EXPECT_FALSE(test.Fires()) << minute;
    test.Add(boat.Block([](const RunError& run) { return 8.0 * run.commanded[2]; }));
  }
  EXPECT_TRUE(test.Fires());
}

TEST(CommandedErrorTest, IsSilentInWeatherHoweverStrong) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SteeredBoat boat(seed);
    CommandedErrorTest gusts(kNormal);
    EXPECT_FALSE(Fires(gusts, boat, [&](const RunError&) { return 20.0 * boat.Gust(); })) << seed;
    CommandedErrorTest wind(kNormal);
    const auto blown = [&](const RunError& run) { return 30.0 * run.weather[1] + boat.Gust(); };
    EXPECT_FALSE(Fires(wind, boat, blown)) << seed;
  }
}

TEST(CommandedErrorTest, IsSilentWithinToleranceHoweverSureTheErrorIs) {
  SteeredBoat boat(3);
  CommandedErrorTest test(kNormal);
  EXPECT_FALSE(Fires(test, boat, [](const RunError& run) { return 1.5 * run.commanded[0]; }));
}

// The commands of one minute are so strong that it alone explains the errors of all.
TEST(CommandedErrorTest, NoSingleMinuteDecides) {
  SteeredBoat boat(4);
  CommandedErrorTest test(kNormal);
  const auto nominal = [&](const RunError&) { return boat.Gust(); };
  for (int minute = 0; minute < 5; ++minute) test.Add(boat.Block(nominal));
  test.Add(boat.Block([](const RunError& run) { return 8.0 * run.commanded[0]; }, 10.0));
  EXPECT_TRUE(test.Rises());
  EXPECT_FALSE(test.Fires());
}

TEST(CommandedErrorTest, EndsOnceErrorsFollowTheCommandsNoMore) {
  SteeredBoat boat(5);
  CommandedErrorTest test(kNormal);
  ASSERT_TRUE(Fires(test, boat, [](const RunError& run) { return 8.0 * run.commanded[0]; }));
  for (int minute = 0; minute < 10; ++minute) test.Add({});
  EXPECT_TRUE(test.Fires()) << "no run tells that it has ended";
  for (int minute = 0; minute < 5; ++minute) {
    test.Add(boat.Block([&](const RunError&) { return boat.Gust(); }));
  }
  EXPECT_FALSE(test.Fires());
}

TEST(CommandedErrorTest, SaysNothingNewInTransit) {
  SteeredBoat boat(6);
  CommandedErrorTest test(kNormal);
  const auto worn = [&](const RunError& run) { return 8.0 * run.commanded[0] + boat.Gust(); };
  for (int minute = 0; minute < 30; ++minute) test.Add(boat.Transit(worn));
  EXPECT_FALSE(test.Fires());
  ASSERT_TRUE(Fires(test, boat, worn));
  for (int minute = 0; minute < 30; ++minute) {
    test.Add(boat.Transit(worn));
    EXPECT_TRUE(test.Fires()) << minute;
  }
}

}  // namespace
}  // namespace telltale
