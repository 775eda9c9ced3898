#include "telltale/core/data/check/input_check.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "telltale/core/data/north_east_frame.hpp"

namespace telltale {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

struct Input {
  std::vector<GnssFix> gnss;
  std::vector<HeadingSample> heading;
  std::vector<ThrusterSample> thrusters;
  Vehicle vehicle;
};

/// A boat whose speed and yaw rate follow its commands by a first order, exact sensors: 200 s of
/// turns to both sides at two speeds.
Input SimulatedInput() {
  constexpr double kStepS = 0.1;
  Input input;
  const NorthEastFrame frame({60.0, 10.0});
  double north = 0.0;
  double east = 0.0;
  double psi = 0.3;
  double u = 0.0;
  double r = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double t = kStepS * i;
    const int phase = (i / 80) % 4;
    const double mean = (i / 400) % 2 == 0 ? 0.5 : 0.3;
    const double difference = phase == 0 ? 0.3 : phase == 2 ? -0.25 : 0.0;
    const PropellerCommand command{mean + difference / 2, mean - difference / 2};
    input.thrusters.push_back({t, input.vehicle.port.PulseWidth(command.port),
                               input.vehicle.starboard.PulseWidth(command.starboard)});
    input.heading.push_back({t, std::remainder(psi * kDegreesPerRadian, 360.0)});
    if (i % 2 == 0) {
      const GeographicPosition position = frame.Inverse({north, east});
      input.gnss.push_back({t, position.latitude_deg, position.longitude_deg});
    }
    north += kStepS * u * std::cos(psi);
    east += kStepS * u * std::sin(psi);
    psi += kStepS * r;
    u += kStepS * (3.0 * mean - u) / 2.0;
    r += kStepS * (1.5 * difference - r) / 0.7;
  }
  return input;
}

std::optional<Refusal> FaultAfter(const std::function<void(Input&)>& change) {
  Input input = SimulatedInput();
  change(input);
  return FirstFault(CheckInput(input.gnss, input.heading, input.thrusters, input.vehicle));
}

void Reverse(PwmChannel& channel) {
  std::swap(channel.full_forward_us, channel.full_reverse_us);
}

TEST(InputCheck, FindsNothingInASoundRecording) {
  EXPECT_EQ(FaultAfter([](Input&) {}), std::nullopt);
}

TEST(InputCheck, SummarisesEachChannel) {
  Input input = SimulatedInput();
  input.heading.erase(input.heading.begin() + 100, input.heading.begin() + 150);
  const InputCheck check = CheckInput(input.gnss, input.heading, input.thrusters, input.vehicle);
  EXPECT_EQ(check.channels[0].samples, 1000u);
  EXPECT_NEAR(check.channels[0].median_period_s, 0.2, 1e-9);
  EXPECT_EQ(check.channels[0].gaps, 0u);
  EXPECT_EQ(check.channels[1].gaps, 1u);
  EXPECT_NEAR(check.channels[1].longest_gap_s, 5.1, 1e-9);
}

struct Fault {
  const char* name;
  std::function<void(Input&)> change;
  const char* reason;
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.reason;
}

class InputFault : public testing::TestWithParam<Fault> {};

TEST_P(InputFault, IsNamed) {
  const auto fault = FaultAfter(GetParam().change);
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->reason, testing::HasSubstr(GetParam().reason));
  EXPECT_FALSE(fault->advice.empty());
}

void ScaleTimes(Input& input, double factor) {
  for (auto& sample : input.gnss) sample.time_s *= factor;
  for (auto& sample : input.heading) sample.time_s *= factor;
  for (auto& sample : input.thrusters) sample.time_s *= factor;
}

void ChangeHeadings(Input& input, const std::function<double(double)>& change) {
  for (auto& sample : input.heading) sample.heading_deg = change(sample.heading_deg);
}

INSTANTIATE_TEST_SUITE_P(
    Each, InputFault,
    testing::Values(
        Fault{"milliseconds", [](Input& i) { ScaleTimes(i, 1e3); }, "in milliseconds"},
        Fault{"microseconds", [](Input& i) { ScaleTimes(i, 1e6); }, "in microseconds"},
        Fault{"exchanged_positions",
              [](Input& i) {
                for (auto& fix : i.gnss) std::swap(fix.latitude_deg, fix.longitude_deg);
              },
              "latitude and longitude seem to be exchanged"},
        Fault{"radians",
              [](Input& i) { ChangeHeadings(i, [](double h) { return h / kDegreesPerRadian; }); },
              "in radians"},
        Fault{"mirrored", [](Input& i) { ChangeHeadings(i, [](double h) { return -h; }); },
              "headings seem to be mirrored"},
        Fault{"from_east", [](Input& i) { ChangeHeadings(i, [](double h) { return 90.0 - h; }); },
              "counted from east"},
        Fault{"from_east_clockwise",
              [](Input& i) { ChangeHeadings(i, [](double h) { return h - 90.0; }); },
              "counted from east, clockwise"},
        Fault{"magnetic", [](Input& i) { ChangeHeadings(i, [](double h) { return h + 20.0; }); },
              "keeps -20 ± 0 degrees from the heading"},
        Fault{"stuck_heading", [](Input& i) { ChangeHeadings(i, [](double) { return 12.0; }); },
              "heading seems to be stuck"},
        Fault{"stuck_port_thruster",
              [](Input& i) {
                for (auto& sample : i.thrusters) sample.port_us = 1600.0;
              },
              "port thruster seems to be stuck"},
        Fault{"stuck_position",
              [](Input& i) {
                for (auto& fix : i.gnss) {
                  fix.latitude_deg = 60.0;
                  fix.longitude_deg = 10.0;
                }
              },
              "gnss seems to be stuck"},
        Fault{"turned_round",
              [](Input& i) {
                ChangeHeadings(i, [](double h) { return std::remainder(h + 180.0, 360.0); });
              },
              "turned round"},
        Fault{"swapped",
              [](Input& i) {
                for (auto& sample : i.thrusters) std::swap(sample.port_us, sample.starboard_us);
              },
              "thrusters seem to be swapped"},
        Fault{"both_reversed",
              [](Input& i) {
                Reverse(i.vehicle.port);
                Reverse(i.vehicle.starboard);
              },
              "both thrusters seem to be reversed"},
        Fault{"port_reversed", [](Input& i) { Reverse(i.vehicle.port); },
              "port thruster seems to be reversed"},
        Fault{"starboard_reversed", [](Input& i) { Reverse(i.vehicle.starboard); },
              "starboard thruster seems to be reversed"},
        Fault{"shares",
              [](Input& i) {
                for (auto& sample : i.thrusters) {
                  sample.port_us = (sample.port_us - 1500.0) / 400.0;
                  sample.starboard_us = (sample.starboard_us - 1500.0) / 400.0;
                }
              },
              "shares or percent"},
        Fault{"narrow_range",
              [](Input& i) {
                i.vehicle.port = {1500.0, 1550.0, 1450.0};
                i.vehicle.starboard = i.vehicle.port;
              },
              "outside the range of the vehicle file"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(InputCheck, AFewDegreesOfDeviationAreNoFault) {
  EXPECT_EQ(FaultAfter([](Input& i) { ChangeHeadings(i, [](double h) { return h + 10.0; }); }),
            std::nullopt);
}

TEST(InputCheck, AClockThatIsSetInBetweenIsNoFault) {
  constexpr double kSetAtS = 30.0;
  constexpr double kSince1970S = 1.7e9;
  const auto set = [](auto& samples) {
    for (auto& sample : samples) sample.time_s += sample.time_s < kSetAtS ? 0.0 : kSince1970S;
  };
  EXPECT_EQ(FaultAfter([&](Input& i) { set(i.gnss), set(i.heading), set(i.thrusters); }),
            std::nullopt);
}

TEST(InputCheck, OutputsThatAreOffWhileDisarmedAreNoFaultOfRange) {
  EXPECT_EQ(FaultAfter([](Input& i) {
              for (auto& sample : i.thrusters) {
                if (sample.time_s < 20.0) sample.port_us = sample.starboard_us = 0.0;
              }
            }),
            std::nullopt);
}

TEST(InputCheck, ABoatThatOnlyDrivesStraightShowsNoFaultOfHeading) {
  Input input = SimulatedInput();
  for (auto& sample : input.heading) sample.heading_deg = 20.0;
  for (auto& sample : input.thrusters) {
    sample.port_us = sample.time_s < 100.0 ? 1700.0 : 1650.0;
    sample.starboard_us = sample.port_us;
  }
  const NorthEastFrame frame({60.0, 10.0});
  for (auto& fix : input.gnss) {
    const GeographicPosition position =
        frame.Inverse({fix.time_s * std::cos(20.0 / kDegreesPerRadian),
                       fix.time_s * std::sin(20.0 / kDegreesPerRadian)});
    fix.latitude_deg = position.latitude_deg;
    fix.longitude_deg = position.longitude_deg;
  }
  EXPECT_EQ(FirstFault(CheckInput(input.gnss, input.heading, input.thrusters, input.vehicle)),
            std::nullopt);
}

}  // namespace
}  // namespace telltale
