// Real and simulated recordings with one fault of input each: identify names the fault and writes
// no model.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/telltale_command.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"
#include "telltale/core/data/check/input_check.hpp"

namespace telltale {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::filesystem::path kTree = TELLTALE_SOURCE_DIR;

struct InputWithFault {
  const char* name;
  std::function<void(Recording&)> alter;
  std::vector<const char*> said;  ///< each is right
};

void PrintTo(const InputWithFault& input, std::ostream* out) {
  *out << input.said.front();
}

void ChangeEachHeading(Recording& recording, const std::function<double(double)>& change) {
  for (HeadingSample& sample : recording.heading) sample.heading_deg = change(sample.heading_deg);
}

void ChangeEachTime(Recording& recording, double factor) {
  for (auto& sample : recording.gnss) sample.time_s *= factor;
  for (auto& sample : recording.heading) sample.time_s *= factor;
  for (auto& sample : recording.thrusters) sample.time_s *= factor;
}

std::vector<InputWithFault> FaultsOfAnyRecording() {
  return {
      {"Milliseconds", [](Recording& r) { ChangeEachTime(r, 1e3); }, {"in milliseconds"}},
      {"Microseconds", [](Recording& r) { ChangeEachTime(r, 1e6); }, {"in microseconds"}},
      {"ExchangedPositions",
       [](Recording& r) {
         for (GnssFix& fix : r.gnss) std::swap(fix.latitude_deg, fix.longitude_deg);
       },
       {"latitude and longitude seem to be exchanged"}},
      {"Radians",
       [](Recording& r) {
         ChangeEachHeading(r, [](double h) { return h * std::numbers::pi / 180.0; });
       },
       {"in radians"}},
      {"Mirrored",
       [](Recording& r) { ChangeEachHeading(r, [](double h) { return 360.0 - h; }); },
       {"mirrored"}},
      {"FromEast",
       [](Recording& r) {
         ChangeEachHeading(r, [](double h) { return std::fmod(450.0 - h, 360.0); });
       },
       {"from east, anticlockwise"}},
      {"FromEastClockwise",
       [](Recording& r) {
         ChangeEachHeading(r, [](double h) { return std::fmod(h + 270.0, 360.0); });
       },
       {"from east, clockwise"}},
      {"Magnetic",
       [](Recording& r) {
         ChangeEachHeading(r, [](double h) { return std::fmod(h + 330.0, 360.0); });
       },
       {"headings seem to be magnetic, or the compass to be turned"}},
      {"SwappedThrusters",
       [](Recording& r) {
         for (ThrusterSample& s : r.thrusters) std::swap(s.port_us, s.starboard_us);
       },
       // Where one channel is declared reversed, exchanged channels are reversed as well.
       {"thrusters seem to be swapped", "thrusters to be both swapped and reversed"}},
      {"ReversedPort",
       [](Recording& r) {
         for (ThrusterSample& s : r.thrusters) s.port_us = 3000.0 - s.port_us;
       },
       {"the port thruster seems to be reversed"}},
      {"ReversedStarboard",
       [](Recording& r) {
         for (ThrusterSample& s : r.thrusters) s.starboard_us = 3000.0 - s.starboard_us;
       },
       {"the starboard thruster seems to be reversed"}},
      {"StuckThruster",
       [](Recording& r) {
         for (ThrusterSample& s : r.thrusters) s.port_us = 1600.0;
       },
       {"port thruster seems to be stuck"}},
      {"StuckHeading",
       [](Recording& r) { ChangeEachHeading(r, [](double) { return 40.0; }); },
       {"heading seems to be stuck"}},
      {"StuckPosition",
       [](Recording& r) {
         const GnssFix held = r.gnss[r.gnss.size() / 2];
         for (std::size_t i = r.gnss.size() / 2; i < r.gnss.size(); ++i) {
           r.gnss[i].latitude_deg = held.latitude_deg;
           r.gnss[i].longitude_deg = held.longitude_deg;
         }
       },
       {"gnss seems to be stuck"}},
      {"Shares",
       [](Recording& r) {
         for (ThrusterSample& s : r.thrusters) {
           s.port_us = (s.port_us - 1500.0) / 400.0;
           s.starboard_us = (s.starboard_us - 1500.0) / 400.0;
         }
       },
       {"shares or percent"}},
  };
}

bool SaysOneOf(const std::string& text, const std::vector<const char*>& said) {
  std::string line;
  for (const char c : text) {  // wrapped for a terminal
    if (c == '\n' || (c == ' ' && !line.empty() && line.back() == ' ')) {
      if (line.empty() || line.back() != ' ') line += ' ';
    } else {
      line += c;
    }
  }
  for (const char* phrase : said) {
    if (line.find(phrase) != std::string::npos) return true;
  }
  return false;
}

class IdentifyInputFault : public testing::TestWithParam<InputWithFault> {};

TEST_P(IdentifyInputFault, OfTheSampleIsNamedAndGivesNoModel) {
  const TemporaryFolder folder;
  const std::string log = (folder.Path() / "log").string();
  const std::string model = (folder.Path() / "model.json").string();
  auto loaded = LoadRecording(kTree / "deploy/sample");
  ASSERT_TRUE(loaded);
  GetParam().alter(loaded->recording);
  WriteTelemetryLog(log, loaded->recording);
  const CommandOutcome outcome =
      Telltale({"identify", "--log", log, "--vehicle",
                (kTree / "deploy/sample/yellowfish.textproto").string(), "--out", model});
  EXPECT_EQ(outcome.exit_code, kExitRefused);
  EXPECT_TRUE(SaysOneOf(outcome.err, GetParam().said)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("->"));
  EXPECT_FALSE(std::filesystem::exists(model));
}

struct RealBoat {
  std::filesystem::path log;
  Vehicle vehicle;
};

std::vector<RealBoat> RealBoats() {
  const char* const shared = std::getenv("TELLTALE_SHARED_DATA");
  if (shared == nullptr) return {};
  std::vector<RealBoat> boats;
  const auto add = [&](const char* log, const PwmChannel& port, const PwmChannel& starboard) {
    Vehicle vehicle;
    vehicle.port = port;
    vehicle.starboard = starboard;
    boats.push_back({std::filesystem::path(shared) / log, vehicle});
  };
  for (const char* run : {"run220", "run225", "run230", "run232", "run234"}) {
    const std::string log = std::string("blueboat/") + run;
    add(log.c_str(), {1511.0, 1911.0, 1111.0}, {1511.0, 1111.0, 1911.0});
  }
  for (const char* log : {"dalian/circle", "dalian/sine"}) add(log, {}, {});
  return boats;
}

std::optional<Refusal> FaultOf(const Recording& recording, const Vehicle& vehicle) {
  return FirstFault(CheckInput(recording.gnss, recording.heading, recording.thrusters, vehicle));
}

TEST(RealInput, ShowsNoFault) {
  const auto boats = RealBoats();
  if (boats.empty()) GTEST_SKIP() << "TELLTALE_SHARED_DATA names no recordings of real boats";
  for (const RealBoat& boat : boats) {
    const auto loaded = LoadRecording(boat.log);
    ASSERT_TRUE(loaded) << boat.log;
    const auto fault = FaultOf(loaded->recording, boat.vehicle);
    EXPECT_EQ(fault, std::nullopt) << boat.log << fault.value_or(Refusal{}).reason;
  }
}

TEST_P(IdentifyInputFault, OfRealRecordingsIsNamed) {
  const auto boats = RealBoats();
  if (boats.empty()) GTEST_SKIP() << "TELLTALE_SHARED_DATA names no recordings of real boats";
  for (const RealBoat& boat : boats) {
    // 50 s of one manoeuvre tell some faults apart, and 90 s end with the thrusters off.
    if (boat.log.filename() == "run230" || boat.log.filename() == "run232" ||
        boat.log.filename() == "run234") {
      continue;
    }
    auto loaded = LoadRecording(boat.log);
    ASSERT_TRUE(loaded) << boat.log;
    GetParam().alter(loaded->recording);
    const auto fault = FaultOf(loaded->recording, boat.vehicle);
    // Headings to one side only do not tell a compass from a current.
    const bool goes_all_around = boat.log.parent_path().filename() == "dalian";
    if (std::string_view(GetParam().name) == "Magnetic" && !goes_all_around) {
      EXPECT_EQ(fault, std::nullopt) << boat.log << ": " << fault.value_or(Refusal{}).reason;
      continue;
    }
    ASSERT_TRUE(fault) << boat.log;
    EXPECT_TRUE(SaysOneOf(fault->reason, GetParam().said)) << boat.log << ": " << fault->reason;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, IdentifyInputFault, testing::ValuesIn(FaultsOfAnyRecording()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(InputFaults, AUserWhoKnowsBetterGetsAModel) {
  const TemporaryFolder folder;
  const std::string log = (folder.Path() / "log").string();
  auto loaded = LoadRecording(kTree / "deploy/sample");
  ASSERT_TRUE(loaded);
  for (ThrusterSample& s : loaded->recording.thrusters) std::swap(s.port_us, s.starboard_us);
  WriteTelemetryLog(log, loaded->recording);
  const std::vector<std::string> identify = {
      "identify",
      "--log",
      log,
      "--vehicle",
      (kTree / "deploy/sample/yellowfish.textproto").string(),
      "--replicates",
      "0"};
  const CommandOutcome refused = Telltale(identify);
  EXPECT_EQ(refused.exit_code, kExitRefused);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("exchange port and starboard"), HasSubstr("--skip-input-check")));
  std::vector<std::string> insisting = identify;
  insisting.emplace_back("--skip-input-check");
  EXPECT_EQ(Telltale(insisting).exit_code, kExitSuccess);
}

TEST(InputFaults, CommandsBeyondTheRangeOfTheVehicleFileAreNamed) {
  auto loaded = LoadRecording(kTree / "deploy/sample");
  ASSERT_TRUE(loaded);
  Vehicle narrow;
  narrow.port = {1500.0, 1600.0, 1400.0};
  narrow.starboard = {1500.0, 1600.0, 1400.0};
  const auto fault = FaultOf(loaded->recording, narrow);
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->reason, HasSubstr("outside the range of the vehicle file"));
  EXPECT_EQ(FaultOf(loaded->recording, Vehicle{}), std::nullopt);
}

TEST(InputFaults, ARecordingGivenTwiceIsRefused) {
  const std::string sample = (kTree / "deploy/sample").string();
  const std::string vehicle = (kTree / "deploy/sample/yellowfish.textproto").string();
  const CommandOutcome twice =
      Telltale({"identify", "--log", sample, "--log", sample, "--vehicle", vehicle});
  EXPECT_EQ(twice.exit_code, kExitRefused);
  EXPECT_THAT(twice.err, HasSubstr("the same recording"));
}

}  // namespace
}  // namespace telltale
