#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "campaign.hpp"
#include "effects.hpp"
#include "environment.hpp"
#include "motion.hpp"
#include "simulated_run.hpp"
#include "support/run_command.hpp"
#include "support/temporary_folder.hpp"
#include "thruster.hpp"

namespace blind::truth {
namespace {

using telltale::TemporaryFolder;
using telltale::TextOfFile;
using testing::AllOf;
using testing::Ge;
using testing::Le;

constexpr double kRounding = 1e-9;  // of a few thousand steps in double

/// A boat whose two sides are alike.
Scenario SymmetricScenario() {
  return {.hull = {}, .weather = {}, .faults = {}};
}

State Simulated(State state, const Scenario& scenario, const Drive& drive,
                const Surroundings& around, double duration_s) {
  for (int step = 0; step < duration_s / kStepS; ++step) {
    state = RungeKuttaStep(state, scenario, drive, around, kStepS);
  }
  return state;
}

/// Every file below a folder by its path from there.
std::map<std::string, std::string> FilesBelow(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[std::filesystem::relative(entry.path(), folder).string()] = TextOfFile(entry.path());
  }
  return files;
}

/// The second column of a CSV file.
std::vector<double> SecondColumn(const std::filesystem::path& file) {
  std::istringstream text(TextOfFile(file));
  std::vector<double> column;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) column.push_back(std::stod(line.substr(line.find(',') + 1)));
  return column;
}

SingleCaseOptions ShortCase(const std::vector<AppliedEffect>& effects) {
  return {.set = Set::kDevelopment,
          .seed = 5,
          .hull = "",
          .effects = effects,
          .onset_s = 0.0,
          .duration_s = 60.0};
}

TEST(Thruster, HasThePublishedEndPointsAndDeadZone) {
  EXPECT_DOUBLE_EQ(BollardThrust(1900), 5.25 * 9.80665);
  EXPECT_DOUBLE_EQ(BollardThrust(1100), -4.1 * 9.80665);
  EXPECT_EQ(BollardThrust(1529), 0.0);
  EXPECT_EQ(BollardThrust(1471), 0.0);
  EXPECT_GT(BollardThrust(1530), 0.0);
  EXPECT_LT(BollardThrust(1470), 0.0);
}

TEST(Thruster, GrowsWithThePulse) {
  for (double pulse = 1101; pulse <= 1900; pulse += 1) {
    EXPECT_GE(BollardThrust(pulse), BollardThrust(pulse - 1)) << pulse;
  }
}

TEST(Thruster, LosesItsStatedShareAtReferenceSpeed) {
  const double full = ShaftSpeed(BollardThrust(1900));
  EXPECT_NEAR(InflowShare(0.1, full, 1.8), 0.9, 1e-5);
  EXPECT_NEAR(InflowShare(0.1, full, 0.0), 1.0, 1e-12);
  EXPECT_GT(InflowShare(0.1, -full, 1.8), 1.0) << "braking pushes harder";
}

TEST(Motion, LosesEnergyWithoutThrust) {
  const Scenario scenario = SymmetricScenario();
  RandomStream rng(3);
  for (int start = 0; start < 20; ++start) {
    State state{.surge_mps = rng.Uniform(-2, 2),
                .sway_mps = rng.Uniform(-1, 1),
                .yaw_radps = rng.Uniform(-2, 2)};
    for (int step = 0; step < 2000; ++step) {
      const double before = KineticEnergy(state, scenario);
      state = RungeKuttaStep(state, scenario, {}, {}, kStepS);
      ASSERT_LT(KineticEnergy(state, scenario), before) << "start " << start << " step " << step;
    }
  }
}

TEST(Motion, IsTheSameInAMirror) {
  const Scenario scenario = SymmetricScenario();
  const State state{.heading_rad = 0.4, .surge_mps = 0.5, .sway_mps = 0.2, .yaw_radps = -0.3};
  State mirrored = state;
  mirrored.heading_rad = -state.heading_rad;
  mirrored.sway_mps = -state.sway_mps;
  mirrored.yaw_radps = -state.yaw_radps;
  const Surroundings around{.wind_north_mps = 2.0,
                            .wind_east_mps = -3.0,
                            .current_north_mps = 0.1,
                            .current_east_mps = 0.2,
                            .waves = {},
                            .shoal = 0.0};
  Surroundings around_mirrored = around;
  around_mirrored.wind_east_mps *= -1.0;
  around_mirrored.current_east_mps *= -1.0;

  const State end =
      Simulated(state, scenario, {.port_us = 1800, .starboard_us = 1350}, around, 20.0);
  const State mirror_end =
      Simulated(mirrored, scenario, {.port_us = 1350, .starboard_us = 1800}, around_mirrored, 20.0);
  EXPECT_NEAR(mirror_end.north_m, end.north_m, kRounding);
  EXPECT_NEAR(mirror_end.east_m, -end.east_m, kRounding);
  EXPECT_NEAR(mirror_end.heading_rad, -end.heading_rad, kRounding);
  EXPECT_NEAR(mirror_end.surge_mps, end.surge_mps, kRounding);
  EXPECT_NEAR(mirror_end.sway_mps, -end.sway_mps, kRounding);
  EXPECT_GT(std::abs(end.heading_rad - state.heading_rad), 1.0) << "nothing was turned";
}

TEST(Motion, IsTheSameInAirAndWaterThatMoveAlong) {
  const Scenario scenario = SymmetricScenario();
  const double north = 0.3, east = -0.2;
  const Drive drive{.port_us = 1750, .starboard_us = 1620};
  const Surroundings moving{.wind_north_mps = north,
                            .wind_east_mps = east,
                            .current_north_mps = north,
                            .current_east_mps = east,
                            .waves = {},
                            .shoal = 0.0};
  const State drifting{.surge_mps = north, .sway_mps = east};  // with the water, heading north
  const State end = Simulated({}, scenario, drive, {}, 20.0);
  const State end_moving = Simulated(drifting, scenario, drive, moving, 20.0);
  EXPECT_NEAR(end_moving.north_m - 20.0 * north, end.north_m, kRounding);
  EXPECT_NEAR(end_moving.east_m - 20.0 * east, end.east_m, kRounding);
  EXPECT_NEAR(end_moving.heading_rad, end.heading_rad, kRounding);
}

TEST(Motion, TurnsToStarboardWhenPortPushesMore) {
  const State end =
      Simulated({}, SymmetricScenario(), {.port_us = 1700, .starboard_us = 1600}, {}, 5.0);
  EXPECT_GT(end.heading_rad, 0.1);
  EXPECT_GT(end.east_m, 0.0);
}

/// What is asked of a boat of this class: about 1.5 to 2 m/s and 0.6 to 1 rad/s, with some margin.
TEST(Fleet, MovesAsBoatsOfItsClassDo) {
  for (const Set set : {Set::kDevelopment, Set::kHeldOut}) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      for (const Hull& hull : Fleet(set, seed)) {
        const Scenario scenario{.hull = hull, .weather = {}, .faults = {}};
        const State ahead =
            Simulated({}, scenario, {.port_us = 1900, .starboard_us = 1900}, {}, 20.0);
        EXPECT_THAT(std::hypot(ahead.surge_mps, ahead.sway_mps), AllOf(Ge(1.4), Le(2.3)))
            << hull.name << seed;
        const State spin =
            Simulated({}, scenario, {.port_us = 1740, .starboard_us = 1260}, {}, 12.0);
        EXPECT_THAT(spin.yaw_radps, AllOf(Ge(0.4), Le(1.1))) << hull.name << seed;
      }
    }
  }
}

TEST(Fleet, IsSharedByNoTwoSets) {
  std::set<std::string> names;
  std::set<double> masses;
  for (const Set set : {Set::kDevelopment, Set::kHeldOut}) {
    for (const Hull& hull : Fleet(set, 1)) {
      EXPECT_TRUE(names.insert(hull.name).second) << hull.name;
      EXPECT_TRUE(masses.insert(hull.mass_kg).second) << hull.name;
    }
  }
  EXPECT_EQ(names.size(), 8u);
}

TEST(Plan, HoldsWhatItPromises) {
  for (const Set set : {Set::kDevelopment, Set::kHeldOut}) {
    std::map<std::string, std::size_t> kinds;
    std::map<std::string, std::set<std::pair<int, int>>> singles;
    std::set<std::uint64_t> days;
    std::map<std::string, std::size_t> in_weather;
    const std::set<std::string> weather{"wind", "current", "waves"};
    for (const Case& planned : PlannedCases(set, 1, 1)) {
      ++kinds[planned.kind];
      std::vector<AppliedEffect> all = planned.effects;
      all.insert(all.end(), planned.weather.begin(), planned.weather.end());
      in_weather[planned.kind] += std::any_of(
          all.begin(), all.end(),
          [&](const AppliedEffect& applied) { return weather.contains(applied.effect); });
      days.insert(planned.day);
      if (planned.kind != "single") continue;
      const AppliedEffect& applied = planned.effects.front();
      singles[applied.effect].insert(
          {static_cast<int>(std::lround(std::log2(applied.size))), applied.sign > 0 ? 1 : -1});
    }
    EXPECT_EQ(kinds["nominal"], 300u);
    EXPECT_EQ(kinds["pair"], 60u);
    EXPECT_EQ(kinds["outside"], 60u);
    for (const auto& [kind, cases] : kinds) EXPECT_EQ(in_weather[kind], cases / 2) << kind;
    EXPECT_EQ(singles.size(), 26u);
    for (const auto& [name, seen] : singles) {
      EXPECT_EQ(seen.size(), EffectNamed(name).has_sign ? 6u : 3u) << name;
    }
    EXPECT_EQ(days.size(), PlannedCases(set, 1, 1).size()) << "two cases are the same day";
  }
}

TEST(Plan, IsDrawnAnewForEverySeedAndSet) {
  const auto kinds = [](Set set, std::uint64_t seed) {
    std::string text;
    for (const Case& planned : PlannedCases(set, seed, 1)) text += planned.kind + " ";
    return text;
  };
  EXPECT_NE(kinds(Set::kDevelopment, 1), kinds(Set::kDevelopment, 2));
  EXPECT_NE(kinds(Set::kDevelopment, 1), kinds(Set::kHeldOut, 1));
}

TEST(Campaign, WritesTheSameBytesForTheSameSeed) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, std::uint64_t seed) {
    const CampaignOptions options{.set = Set::kHeldOut,
                                  .seed = seed,
                                  .repeats = 1,
                                  .nominal_days = {},
                                  .most_cases = 3,
                                  .duration_s = 12.0,
                                  .again = false};
    WriteCampaign(options, folder.Path() / name, [](std::size_t, std::size_t) {});
    return FilesBelow(folder.Path() / name);
  };
  const auto files = write("one", 7);
  EXPECT_EQ(files.size(), 4u * (1 + 7 * 3) + 3u * (3 + 1 + 1));
  EXPECT_EQ(files, write("again", 7));
  const auto other = write("other", 8);
  EXPECT_NE(files.at("cases/001/log/gnss.csv"), other.at("cases/001/log/gnss.csv"));
}

TEST(Campaign, SimulatesSecondRecordingsWithoutChangingTheFirst) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, bool again) {
    const CampaignOptions options{.set = Set::kHeldOut,
                                  .seed = 7,
                                  .repeats = 1,
                                  .nominal_days = {},
                                  .most_cases = 2,
                                  .duration_s = 12.0,
                                  .again = again};
    WriteCampaign(options, folder.Path() / name, [](std::size_t, std::size_t) {});
    return FilesBelow(folder.Path() / name);
  };
  const auto once = write("once", false);
  const auto twice = write("twice", true);
  EXPECT_EQ(twice.size(), once.size() + 2u * 3u);
  for (const auto& [name, content] : once) EXPECT_EQ(twice.at(name), content) << name;
  for (const char* file : {"gnss.csv", "heading.csv", "thrusters.csv"}) {
    EXPECT_NE(twice.at("cases/002/again/" + std::string(file)),
              twice.at("cases/002/log/" + std::string(file)));
  }
}

TEST(Campaign, SimulatesNominalDaysThatAreNoneOfTheCases) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, std::optional<std::size_t> nominal_days) {
    const CampaignOptions options{.set = Set::kHeldOut,
                                  .seed = 7,
                                  .repeats = 1,
                                  .nominal_days = nominal_days,
                                  .most_cases = 5,
                                  .duration_s = 12.0,
                                  .again = false};
    WriteCampaign(options, folder.Path() / name, [](std::size_t, std::size_t) {});
    return FilesBelow(folder.Path() / name);
  };
  const auto cases = write("cases", std::nullopt);
  const auto days = write("days", 5);
  ASSERT_EQ(days.size(), cases.size());
  for (const auto& [name, content] : days) {
    if (name.starts_with("hulls/")) {
      EXPECT_EQ(cases.at(name), content) << name;
    }
    if (name.ends_with("gnss.csv") && name.starts_with("cases/")) {
      EXPECT_NE(cases.at(name), content) << name;
    }
  }
}

TEST(Plan, DistributesNominalDaysThatAreNoneOfTheCases) {
  std::set<std::uint64_t> taken;
  for (const Case& planned : PlannedCases(Set::kHeldOut, 1, 20)) taken.insert(planned.day);
  std::map<std::size_t, int> by_hull;
  for (const Case& planned : NominalDays(Set::kHeldOut, 1, 300)) {
    EXPECT_EQ(planned.kind, "nominal");
    EXPECT_TRUE(taken.insert(planned.day).second) << "a day twice";
    ++by_hull[planned.hull];
  }
  EXPECT_EQ(by_hull.size(), 4u);
  for (const auto& [hull, days] : by_hull) EXPECT_EQ(days, 75) << hull;
}

/// The forces of a sea that runs north past a boat which lies still and heads north, ten a second.
std::vector<BodyForce> ForcesOf(const Weather& weather, double duration_s) {
  Scenario scenario = SymmetricScenario();
  scenario.weather = weather;
  const Environment sea(RandomStream(7));
  std::vector<BodyForce> forces;
  for (double time = 0.0; time < duration_s; time += 0.1) {
    forces.push_back(sea.At(scenario, {}, time).waves);
  }
  return forces;
}

Weather WindSea(double force_n, double period_s, double spread_rad) {
  Weather weather;
  weather.wave_force_n = force_n;
  weather.wave_period_s = period_s;
  weather.is_wind_sea = true;
  weather.wave_spread_rad = spread_rad;
  return weather;
}

double MeanSquare(const std::vector<BodyForce>& forces, double BodyForce::*component) {
  double sum = 0.0;
  for (const BodyForce& force : forces) sum += force.*component * force.*component;
  return sum / static_cast<double>(forces.size());
}

TEST(WindSea, HasTheEnergyOfTheRegularSeaOfItsForce) {
  EXPECT_NEAR(MeanSquare(ForcesOf(WindSea(10.0, 2.0, 0.0), 4000.0), &BodyForce::x_n),
              0.5 * 10.0 * 10.0, 1.5);
}

// Pierson and Moskowitz: the share exp(-5/4 (peak / frequency)^4) of the energy is below a
// frequency. 24 components give it to a twenty-fourth.
TEST(WindSea, HasThePiersonMoskowitzSpectrum) {
  constexpr double kPeriodS = 2.0, kDurationS = 1000.0;
  const auto forces = ForcesOf(WindSea(10.0, kPeriodS, 0.0), kDurationS);
  const auto share_below = [&](double frequency_hz) {
    double energy = 0.0;
    for (int cycles = 1; cycles < frequency_hz * kDurationS; ++cycles) {
      double c = 0.0, s = 0.0;
      for (std::size_t i = 0; i < forces.size(); ++i) {
        const double phase =
            2.0 * std::numbers::pi * cycles * static_cast<double>(i) / double(forces.size());
        c += forces[i].x_n * std::cos(phase);
        s += forces[i].x_n * std::sin(phase);
      }
      energy += 2.0 * (c * c + s * s) / (double(forces.size()) * double(forces.size()));
    }
    return energy / MeanSquare(forces, &BodyForce::x_n);
  };
  for (const double over_peak : {0.8, 1.0, 1.3, 1.8}) {
    EXPECT_NEAR(share_below(over_peak / kPeriodS), std::exp(-1.25 * std::pow(over_peak, -4.0)),
                1.5 / 24.0)
        << over_peak;
  }
}

// A component that runs at a normal angle of 0.5 rad has sin^2 of (1 - exp(-0.5)) / 2 = 0.20 on
// average.
TEST(WindSea, ComesFromManySidesWhereItIsShortCrested) {
  const auto aside = [](double spread_rad) {
    const auto forces = ForcesOf(WindSea(10.0, 2.0, spread_rad), 2000.0);
    return MeanSquare(forces, &BodyForce::y_n) /
           (1.44 * MeanSquare(forces, &BodyForce::x_n) + MeanSquare(forces, &BodyForce::y_n));
  };
  EXPECT_LT(aside(0.05), 0.01);
  EXPECT_NEAR(aside(0.5), 0.20, 0.1);
}

TEST(Environment, ACurrentDriftsAsLongAsItSays) {
  constexpr int kSeas = 2000;
  constexpr double kDriftMps = 0.05, kDriftS = 100.0;
  Scenario scenario = SymmetricScenario();
  scenario.weather = {
      .current_mps = 0.2, .current_drift_mps = kDriftMps, .current_drift_s = kDriftS};
  double square = 0.0, product = 0.0;
  for (int seed = 0; seed < kSeas; ++seed) {
    Environment sea{RandomStream(seed)};
    const double first = sea.At(scenario, {}, 0.0).current_north_mps - 0.2;
    for (double time = 0.0; time < kDriftS; time += 1.0) sea.Advance(scenario.weather, 1.0);
    const double second = sea.At(scenario, {}, kDriftS).current_north_mps - 0.2;
    square += first * first / kSeas;
    product += first * second / kSeas;
  }
  EXPECT_NEAR(std::sqrt(square), kDriftMps, 0.1 * kDriftMps);
  EXPECT_NEAR(product / square, std::exp(-1.0), 0.1);
}

TEST(Effects, DrawWeatherWithinWhatIsPromised) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto day = [&](const char* effect) {
      Scenario scenario = SymmetricScenario();
      RandomStream rng(seed);
      EffectNamed(effect).apply(scenario, 1.0, 1.0, rng);
      return scenario.weather;
    };
    EXPECT_THAT(1.0 / day("waves").wave_period_s, AllOf(Ge(0.15), Le(0.8)));
    EXPECT_THAT(day("wind").gust_share, AllOf(Ge(0.1), Le(0.2)));
    EXPECT_THAT(day("wind").gust_time_s, AllOf(Ge(3.0), Le(20.0)));
    EXPECT_THAT(day("current").current_drift_s, AllOf(Ge(60.0), Le(300.0)));
  }
}

TEST(SingleCase, EveryEffectShowsInTheLog) {
  const TemporaryFolder folder;
  const auto written = [&](const std::string& name, const std::vector<AppliedEffect>& effects) {
    SingleCaseOptions options = ShortCase(effects);
    options.duration_s = 150.0;  // wash and weed come and go
    EXPECT_THAT(WriteSingleCase(options, folder.Path() / name),
                testing::HasSubstr(effects.empty() ? "nominal" : name));
    return FilesBelow(folder.Path() / name / "log");
  };
  const auto nominal = written("nominal", {});
  for (const Effect& effect : Effects()) {
    const auto files = written(effect.name, {{effect.name, 1.0, 1.0}});
    EXPECT_TRUE(files.at("gnss.csv") != nominal.at("gnss.csv") ||
                files.at("heading.csv") != nominal.at("heading.csv"))
        << effect.name;
  }
}

TEST(SingleCase, TurnsOnlyTheCompassByAHeadingBias) {
  const TemporaryFolder folder;
  WriteSingleCase(ShortCase({}), folder.Path() / "nominal");
  WriteSingleCase(ShortCase({{"heading_bias", 2.0, -1.0}}), folder.Path() / "biased");
  const auto nominal = SecondColumn(folder.Path() / "nominal/log/heading.csv");
  const auto biased = SecondColumn(folder.Path() / "biased/log/heading.csv");
  ASSERT_EQ(nominal.size(), biased.size());
  for (std::size_t row = 0; row < nominal.size(); ++row) {
    // Twice the typical 3 degrees, to port; headings are written to 1e-4.
    EXPECT_NEAR(std::remainder(biased[row] - nominal[row], 360.0), -6.0, 1.1e-4) << row;
  }
  EXPECT_EQ(TextOfFile(folder.Path() / "nominal/log/gnss.csv"),
            TextOfFile(folder.Path() / "biased/log/gnss.csv"));
}

TEST(SingleCase, StampsEachChannelByAClockOfItsOwn) {
  const TemporaryFolder folder;
  WriteSingleCase(ShortCase({}), folder.Path());
  std::set<double> starts;
  for (const char* file : {"gnss.csv", "heading.csv", "thrusters.csv"}) {
    std::istringstream text(TextOfFile(folder.Path() / "log" / file));
    std::string header, row;
    std::getline(text, header);
    std::getline(text, row);
    starts.insert(std::stod(row));
  }
  EXPECT_EQ(starts.size(), 3u);
  EXPECT_LT(*starts.rbegin() - *starts.begin(), 0.25)
      << "clocks differ by less than a tenth and some";
}

TEST(SimulatedRun, CommandsChangeBetweenTheSamplesOfTheLog) {
  const TemporaryFolder folder;
  WriteSingleCase(ShortCase({}), folder.Path());
  const Scenario nominal = SymmetricScenario();
  const Track track =
      Simulate({nominal, nominal, 0.0, 60.0},
               DrawnMission(Set::kDevelopment, 60.0, RandomStream(3)), RandomStream(3));
  std::size_t between = 0;
  for (std::size_t at = 1; at < track.commands.size(); ++at) {
    between += at % 5 != 0 && track.commands[at].port_us != track.commands[at - 1].port_us;
  }
  EXPECT_GT(between, 5u);
  const std::size_t samples = SecondColumn(folder.Path() / "log/thrusters.csv").size();
  EXPECT_EQ(samples, (track.commands.size() - 1) / 5 + 1);
}

TEST(SingleCase, IsNominalUntilTheOnset) {
  const TemporaryFolder folder;
  WriteSingleCase(ShortCase({}), folder.Path() / "nominal");
  SingleCaseOptions options = ShortCase({{"thruster_imbalance", 2.0, 1.0}});
  options.onset_s = 30.0;
  WriteSingleCase(options, folder.Path() / "late");
  const auto nominal = SecondColumn(folder.Path() / "nominal/log/heading.csv");
  const auto late = SecondColumn(folder.Path() / "late/log/heading.csv");
  constexpr std::ptrdiff_t kRowsBefore = 30 * 20;
  EXPECT_TRUE(std::equal(nominal.begin(), nominal.begin() + kRowsBefore, late.begin()));
  EXPECT_FALSE(std::equal(nominal.begin(), nominal.end(), late.begin()));
}

TEST(SingleCase, RefusesWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  EXPECT_THROW(WriteSingleCase(ShortCase({{"gremlins"}}), folder.Path()), std::invalid_argument);
  SingleCaseOptions options = ShortCase({});
  options.hull = "bounty";
  EXPECT_THROW(WriteSingleCase(options, folder.Path()), std::invalid_argument);
}

}  // namespace
}  // namespace blind::truth
