#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <numeric>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "telltale/client/recording/telemetry_log/telemetry_log.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

std::uint64_t Sum(const std::array<std::uint64_t, kChannels.size()>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::uint64_t ShedOf(const Quality& quality, Channel channel) {
  return quality.shed[static_cast<std::size_t>(channel)];
}

/// What became of all samples of a boat. None of those of `telltale load` is rejected.
std::uint64_t Accounted(const Quality& quality) {
  return quality.accepted + quality.lost + Sum(quality.shed);
}

/// Whether the first reason of a report has this code.
std::function<bool(const Quality&)> SaysFirst(const std::string& code) {
  return [code](const Quality& quality) {
    return !quality.reasons.empty() && quality.reasons.front().code == code;
  };
}

/// A daemon, and the boats of `telltale load`, which send more than it takes in.
class OverloadedDaemon : public ServiceTest {
 protected:
  static constexpr int kBoats = 8;

  /// `limits`: lines of the configuration.
  std::unique_ptr<Process> StartWith(const std::string& limits) {
    Run({"load", "--boats", std::to_string(kBoats), "--write-vehicles", folder_.Path() / "boats"});
    config_file_ = folder_.Write(
        "overloaded.textproto",
        "domain: " + std::to_string(domain_.id()) +
            "\nvehicle_files: \"vehicle.textproto\"\nvehicle_folder: \"boats\"\n" + StorageLines() +
            "identification { bootstrap_replicates: 100 }\nquality_period_s: 0.1\n" + limits);
    return StartDaemon(kBoats + 1);
  }

  /// The boats send `times` as much as usual.
  std::unique_ptr<Process> StartLoad(int times, int duration_s) const {
    return Start({"load", "--boats", std::to_string(kBoats), "--times", std::to_string(times),
                  "--duration", std::to_string(duration_s)});
  }

  /// How many samples each boat of the load, which has ended, has sent.
  static std::uint64_t SentByEach(Process& load) {
    EXPECT_EQ(load.Wait(), 0) << load.output();
    const std::string output = load.output();
    std::smatch sent;
    EXPECT_TRUE(std::regex_search(output, sent, std::regex("boats sent (\\d+) samples")));
    return std::stoull(sent[1]) / kBoats;
  }

  /// The report on a boat of the load once it accounts for every sample but the first: they leave
  /// before the daemon knows of the load's writers.
  std::optional<Quality> AwaitAll(int boat, std::uint64_t sent) const {
    return AwaitQuality("load-0000" + std::to_string(boat), [sent](const Quality& quality) {
      return Accounted(quality) >= sent - sent / 20;
    });
  }
};

// The boats send 8 x 325 samples a second and the daemon takes in 520, 65 of each. By the rule, 25
// of 250 headings, 5 of 25 fixes and all 50 commands would be 80, so of the commands it takes
// in 35.
TEST_F(OverloadedDaemon, ShedsByRuleCountsWhatItShedsAndAnswers) {
  {
    const auto before = StartDaemon();
    ReplaySimulation();
    ASSERT_TRUE(AwaitSavedWindow());
  }
  const auto daemon = StartWith("intake { samples_per_s: 520 }\n");
  const auto started = std::chrono::steady_clock::now();
  const auto load = StartLoad(5, 12);
  ASSERT_TRUE(daemon->WaitForOutput("the fleet sends")) << daemon->output();
  const auto identify = Start({"identify", "--vehicle-id", kVehicleId});
  EXPECT_TRUE(AwaitQuality("load-00001", SaysFirst("SHED")));

  const std::uint64_t sent = SentByEach(*load);
  // A load that gets no processor in time sends its samples over a longer while.
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  EXPECT_EQ(identify->Wait(), 0) << identify->output();
  const double duration_s = static_cast<double>(sent) / 325.0;
  for (int boat = 1; boat <= kBoats; ++boat) {
    const auto quality = AwaitAll(boat, sent);
    ASSERT_TRUE(quality) << boat;
    // What all boats may send in a second comes in 0.2 s, before anything is thinned.
    EXPECT_LE(quality->accepted, 65.0 * (took.count() + 1.0)) << boat;
    const auto taken = [&](Channel channel, double sent_per_s) {
      return sent_per_s * duration_s - static_cast<double>(ShedOf(*quality, channel));
    };
    EXPECT_LT(taken(Channel::kHeading, 250.0), 0.15 * 250.0 * took.count()) << boat;
    EXPECT_LT(taken(Channel::kGnss, 25.0), 10.0 * took.count()) << boat;
    EXPECT_LT(ShedOf(*quality, Channel::kThrusters), 20.0 * took.count()) << boat;
  }
  daemon->Signal(SIGTERM);
  EXPECT_EQ(daemon->Wait(), 0);
  const std::string log = daemon->output();
  const auto first = log.find("the fleet sends");
  EXPECT_EQ(log.find("the fleet sends", first + 1), std::string::npos) << log;
}

// Each boat sends too much, and the log names the first five.
TEST_F(OverloadedDaemon, ThinsTheBoatThatSendsTooMuch) {
  const auto daemon = StartWith("intake { vehicle_samples_per_s: 65 }\n");
  const auto load = StartLoad(2, 5);
  ASSERT_TRUE(daemon->WaitForOutput("samples/s, and 65 are taken in")) << daemon->output();
  const std::uint64_t sent = SentByEach(*load);
  const auto quality = AwaitAll(1, sent);
  ASSERT_TRUE(quality);
  // On a busy machine late samples come at once, and look like more.
  EXPECT_NEAR(static_cast<double>(Sum(quality->shed)), static_cast<double>(sent) / 2.0, 70.0);
  EXPECT_GE(ShedOf(*quality, Channel::kHeading), 9 * Sum(quality->shed) / 10);
}

// 5 headings, half a fix and one command a second instead of 50, 5 and 10.
TEST_F(OverloadedDaemon, IsSentLessWhereTheLoadIsSetSo) {
  const auto daemon = StartWith("");
  const auto load =
      Start({"load", "--boats", std::to_string(kBoats), "--times", "0.1", "--duration", "4"});
  EXPECT_EQ(SentByEach(*load), 4u * 5 + 2 + 4);
}

// A replay ends once the daemon has accounted for every sample.
TEST_F(OverloadedDaemon, CountsAsShedWhatIsMissing) {
  const auto daemon = StartWith("intake { vehicle_samples_per_s: 500 }\n");
  const Recording recording = SimulatedRecording();
  const auto log = folder_.Path() / "log";
  WriteTelemetryLog(log, recording);
  const auto replay = Start({"replay", "--log", log, "--vehicle-id", kVehicleId, "--speed", "60"});
  EXPECT_EQ(replay->Wait(), 0) << replay->output();
  EXPECT_THAT(replay->output(), HasSubstr("all received"));
  const auto quality =
      AwaitQuality(kVehicleId, [&](const Quality& q) { return Accounted(q) == SizeOf(recording); });
  ASSERT_TRUE(quality);
  EXPECT_EQ(quality->lost, 0u);
  EXPECT_TRUE(quality->rejected.empty());
  EXPECT_GT(Sum(quality->shed), SizeOf(recording) / 2);
  EXPECT_THAT(replay->output(), HasSubstr(std::to_string(Sum(quality->shed)) + " samples shed"));
}

// 8 boats share 1 MiB with the ninth, 116508 bytes each: 6500 samples of 17.8 bytes, which come in
// 5 s. What is older goes, and it goes by samples.
TEST_F(OverloadedDaemon, KeepsItsWindowsWithinTheMemoryOfAll) {
  constexpr std::uint64_t kTotal = 1u << 20;
  const auto daemon = StartWith("window { total_memory_mib: 1 }\n");
  const auto load = StartLoad(20, 8);
  const std::uint64_t sent = SentByEach(*load);
  std::uint64_t held = 0;
  for (int boat = 1; boat <= kBoats; ++boat) {
    const auto quality = AwaitAll(boat, sent);
    ASSERT_TRUE(quality) << boat;
    EXPECT_EQ(Sum(quality->shed), 0u);
    held += quality->window_bytes;
  }
  EXPECT_LE(held, kTotal * kBoats / (kBoats + 1));
  EXPECT_GE(held, kTotal * kBoats / (kBoats + 1) - kBoats * 128);
}

}  // namespace
}  // namespace telltale
