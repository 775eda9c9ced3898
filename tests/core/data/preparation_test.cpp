#include "telltale/core/data/preparation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "telltale/core/data/north_east_frame.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr double kDegrees = 180.0 / std::numbers::pi;
const FrameOrigin kOrigin{37.4205, -5.9944};

struct Pose {
  double x, y, psi;
};

/// Where and when a made-up boat is measured.
struct Scene {
  std::function<Pose(double)> pose;
  std::function<ThrusterSample(double)> thrusters = [](double t) {
    return ThrusterSample{t, 1700.0, 1700.0};
  };
  std::function<double(double)> jitter = [](double t) { return t; };
  double start_s = 100.0;
  double duration_s = 60.0;
  double gnss_period_s = 0.2;
  double heading_period_s = 0.02;
  double thruster_period_s = 0.1;
  LeverArm arm = {};
};

Vehicle VehicleWith(const LeverArm& antenna) {
  Vehicle vehicle;
  vehicle.gnss_antenna = antenna;
  return vehicle;
}

std::vector<double> Instants(const Scene& scene, double period) {
  std::vector<double> instants;
  for (int i = 0; i * period <= scene.duration_s + 1e-9; ++i) {
    instants.push_back(scene.jitter(scene.start_s + i * period));
  }
  return instants;
}

Recording Record(const Scene& scene) {
  const NorthEastFrame frame(kOrigin);
  Recording recording;
  for (const double t : Instants(scene, scene.gnss_period_s)) {
    const auto [x, y, psi] = scene.pose(t - scene.start_s);
    const double c = std::cos(psi);
    const double s = std::sin(psi);
    const auto p = frame.Inverse({x + c * scene.arm.forward_m - s * scene.arm.starboard_m,
                                  y + s * scene.arm.forward_m + c * scene.arm.starboard_m});
    recording.gnss.push_back({t, p.latitude_deg, p.longitude_deg});
  }
  for (const double t : Instants(scene, scene.heading_period_s)) {
    const double heading = scene.pose(t - scene.start_s).psi * kDegrees;
    recording.heading.push_back({t, heading - 360.0 * std::floor(heading / 360.0)});
  }
  for (const double t : Instants(scene, scene.thruster_period_s)) {
    ThrusterSample sample = scene.thrusters(t - scene.start_s);
    sample.time_s = t;
    recording.thrusters.push_back(sample);
  }
  return recording;
}

// Surge u, sway v and yaw rate r held: a circle.
std::function<Pose(double)> Circle(double u, double v, double r) {
  return [=](double t) {
    const double psi = r * t;
    return Pose{(u * std::sin(psi) + v * (std::cos(psi) - 1.0)) / r,
                (u * (1.0 - std::cos(psi)) + v * std::sin(psi)) / r, psi};
  };
}

std::function<double(double)> Jitter(double amplitude_s) {
  return [amplitude_s](double t) {
    return t + amplitude_s * std::sin(1000.0 * t) * std::cos(377.0 * t);
  };
}

void ExpectVelocities(const PreparedDataset& dataset, const Nu& nu, double tolerance) {
  for (const PreparedRow& row : dataset.rows) {
    ASSERT_NEAR(row.nu.u, nu.u, tolerance) << "at " << row.time_s;
    ASSERT_NEAR(row.nu.v, nu.v, tolerance) << "at " << row.time_s;
    ASSERT_NEAR(row.nu.r, nu.r, tolerance) << "at " << row.time_s;
  }
}

// The mean over h of a turning velocity falls short of it by u (r h)^2 / 24, here 1e-4 m/s; the
// rest of the tolerance is interpolation.
constexpr double kChord = 5e-4;

TEST(PrepareRobust, RecoversTheVelocitiesOfACircle) {
  const Recording recording = Record({.pose = Circle(1.2, 0.15, 0.2)});
  const auto dataset = Prepare(recording, Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset) << dataset.error().reason;
  EXPECT_DOUBLE_EQ(dataset->sampling_period_s, 0.2);
  EXPECT_EQ(dataset->rows.size(), 301u);
  EXPECT_EQ(dataset->segments.size(), 1u);
  ExpectVelocities(*dataset, {1.2, 0.15, 0.2}, kChord);
}

TEST(Prepare, LeavesReadingsOutOfADatasetThatIsTheSameOtherwise) {
  const Recording recording = Record({.pose = Circle(1.2, 0.15, 0.2)});
  const auto with = Prepare(recording, Vehicle{}, PrepareOptions::Robust());
  const auto without = Prepare(recording, Vehicle{}, PrepareOptions::Robust(), Readings::kLeftOut);
  ASSERT_TRUE(with && without);
  EXPECT_EQ(with->signals.size(), with->segments.size());
  EXPECT_TRUE(without->signals.empty());
  ASSERT_EQ(without->rows.size(), with->rows.size());
  EXPECT_EQ(without->rows.back().nu.u, with->rows.back().nu.u);
  EXPECT_EQ(without->sensors.position_noise_m, with->sensors.position_noise_m);
}

TEST(PrepareRobust, RecoversAFastSpin) {
  const Recording recording = Record({.pose = Circle(0.3, 0.0, 1.5)});
  const auto dataset = Prepare(recording, Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  ExpectVelocities(*dataset, {0.3, 0.0, 1.5}, 3e-3);
}

// Ahead at 1 m/s, every five seconds it begins or ends to turn: there a heading smoothed over
// 3.2 s is off by up to 0.1 rad, which would make 0.1 m/s of sway of what is surge.
TEST(PrepareRobust, ShowsNoSwayInATurn) {
  constexpr double kTurnS = 5.0;
  constexpr double kRate = 0.8;
  const auto pose = [&](double t) {
    Pose at{0.0, 0.0, 0.0};
    for (double from = 0.0; from < t; from += kTurnS) {
      const double lasts = std::min(kTurnS, t - from);
      const double r = std::fmod(from, 2.0 * kTurnS) < kTurnS ? 0.0 : kRate;
      const double psi = at.psi + r * lasts;
      at.x += r == 0.0 ? std::cos(psi) * lasts : (std::sin(psi) - std::sin(at.psi)) / r;
      at.y += r == 0.0 ? std::sin(psi) * lasts : (std::cos(at.psi) - std::cos(psi)) / r;
      at.psi = psi;
    }
    return at;
  };
  PrepareOptions options;
  options.smoothing_half_width = 8;
  const auto dataset = Prepare(Record({.pose = pose}), VehicleWith({}), options);
  ASSERT_TRUE(dataset);
  for (const PreparedRow& row : dataset->rows) {
    EXPECT_NEAR(row.nu.v, 0.0, 0.005) << row.time_s;  // a heading averaged over 0.2 s has corners
  }
}

TEST(PreparePaper, RecoversTheVelocitiesOfACircleToItsDifferencesError) {
  const Recording recording = Record({.pose = Circle(1.2, 0.15, 0.2)});
  const auto dataset = Prepare(recording, Vehicle{}, PrepareOptions::Paper());
  ASSERT_TRUE(dataset);
  // One-sided differences at the two ends are off by u r h / 2 = 0.024 m/s; inside, central
  // differences are off by u (r h)^2 / 6.
  ExpectVelocities(*dataset, {1.2, 0.15, 0.2}, 0.03);
  for (std::size_t row = 20; row + 20 < dataset->rows.size(); ++row) {
    ASSERT_NEAR(dataset->rows[row].nu.u, 1.2, 1e-3);
    ASSERT_NEAR(dataset->rows[row].nu.v, 0.15, 1e-3);
  }
}

struct Named {
  Preset preset;
};

void PrintTo(const Named& named, std::ostream* out) {
  *out << Name(named.preset);
}

class EitherPreset : public ::testing::TestWithParam<Named> {
 protected:
  PrepareOptions Options() const {
    return GetParam().preset == Preset::kPaper ? PrepareOptions::Paper() : PrepareOptions::Robust();
  }
};
INSTANTIATE_TEST_SUITE_P(Presets, EitherPreset,
                         ::testing::Values(Named{Preset::kPaper}, Named{Preset::kRobust}));

TEST_P(EitherPreset, RemovesTheLeverArm) {
  const LeverArm arm{0.8, -0.3};
  const auto pose = Circle(1.0, 0.1, 0.3);
  const auto with = Prepare(Record({.pose = pose, .arm = arm}), VehicleWith(arm), Options());
  const auto without = Prepare(Record({.pose = pose}), Vehicle{}, Options());
  ASSERT_TRUE(with && without);
  for (std::size_t row = 0; row < with->rows.size(); ++row) {
    // Headings averaged over h shift a turning arm by |l| (r h)^2 / 24 at most.
    ASSERT_NEAR(with->rows[row].nu.u, without->rows[row].nu.u, 1e-3);
    ASSERT_NEAR(with->rows[row].nu.v, without->rows[row].nu.v, 1e-3);
  }
}

TEST(PrepareRobust, ShowsAnUnstatedLeverArmAsSway) {
  const LeverArm arm{0.8, 0.0};
  const auto dataset = Prepare(Record({.pose = Circle(1.0, 0.0, 0.3), .arm = arm}), Vehicle{},
                               PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  EXPECT_NEAR(dataset->rows[100].nu.v, 0.3 * 0.8, 1e-3);  // r times the arm
}

TEST_P(EitherPreset, CrossesNorthWithoutAJump) {
  // The heading oscillates across north; the truth at t is psi = 0.3 sin(0.5 t).
  const auto pose = [](double t) { return Pose{0.0, 0.0, 0.3 * std::sin(0.5 * t)}; };
  const auto dataset = Prepare(Record({.pose = pose}), Vehicle{}, Options());
  ASSERT_TRUE(dataset);
  for (const PreparedRow& row : dataset->rows) {
    const double t = row.time_s - 100.0;
    ASSERT_NEAR(row.eta.psi_rad - dataset->rows[0].eta.psi_rad, 0.3 * std::sin(0.5 * t), 0.01);
    ASSERT_NEAR(row.nu.r, 0.15 * std::cos(0.5 * t), 0.01);
  }
}

TEST(PrepareRobust, ToleratesJitterOfTheStamps) {
  const Recording recording = Record({.pose = Circle(1.2, 0.15, 0.2), .jitter = Jitter(0.008)});
  const auto dataset = Prepare(recording, Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  EXPECT_DOUBLE_EQ(dataset->sampling_period_s, 0.2);
  ExpectVelocities(*dataset, {1.2, 0.15, 0.2}, 1e-3);
}

TEST(PrepareRobust, UnevenFixesAreInterpolated) {
  Recording recording = Record({.pose = Circle(1.2, 0.15, 0.2)});
  std::mt19937 engine(3);
  std::erase_if(recording.gnss, [&](const GnssFix&) { return engine() % 4 == 0; });
  const auto dataset = Prepare(recording, Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  // At the end of a segment a hole of two periods has a neighbour on one side only; a parabola
  // misses the arc there by u r^2 (0.4 s)^3 / 15 = 0.2 mm, a line by u r (0.4 s)^2 / 8 = 5 mm.
  ExpectVelocities(*dataset, {1.2, 0.15, 0.2}, 0.01);
}

TEST(PrepareRobust, ADatasetKeepsItsGrid) {
  const auto dataset = Prepare(Record({.pose = Circle(1, 0, 0.1), .jitter = Jitter(0.01)}),
                               Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  for (const RowRange& segment : dataset->segments) {
    for (std::size_t row = segment.begin + 1; row < segment.end; ++row) {
      ASSERT_NEAR(dataset->rows[row].time_s - dataset->rows[row - 1].time_s,
                  dataset->sampling_period_s, 1e-9);
    }
  }
}

TEST_P(EitherPreset, CutsAtGapsOfAnyChannel) {
  Recording recording = Record({.pose = Circle(1, 0, 0.1)});
  std::erase_if(recording.gnss, [](const GnssFix& s) { return s.time_s > 115 && s.time_s < 117; });
  std::erase_if(recording.heading,
                [](const HeadingSample& s) { return s.time_s > 130 && s.time_s < 132; });
  std::erase_if(recording.thrusters,
                [](const ThrusterSample& s) { return s.time_s > 133 && s.time_s < 140; });
  const auto dataset = Prepare(recording, Vehicle{}, Options());
  ASSERT_TRUE(dataset);
  // [100, 115], [117, 130] and [140, 160]; [132, 133] is too short.
  ASSERT_EQ(dataset->segments.size(), 3u);
  const auto start = [&](int i) { return dataset->rows[dataset->segments[i].begin].time_s; };
  const auto end = [&](int i) { return dataset->rows[dataset->segments[i].end - 1].time_s; };
  EXPECT_NEAR(start(0), 100.0, 0.21);
  EXPECT_NEAR(end(0), 115.0, 0.21);
  EXPECT_NEAR(start(1), 117.0, 0.21);
  EXPECT_NEAR(end(1), 130.0, 0.21);
  EXPECT_NEAR(start(2), 140.0, 0.21);
  EXPECT_NEAR(end(2), 160.0, 0.21);
}

TEST_P(EitherPreset, SlicesPartitionSegmentsAndHoldOneRegion) {
  const auto thrusters = [](double t) {
    return ThrusterSample{t, std::fmod(t, 14.0) < 7.0 ? 1700.0 : 1300.0, 1700.0};
  };
  Recording recording = Record({.pose = Circle(1, 0, 0.1), .thrusters = thrusters});
  std::erase_if(recording.gnss, [](const GnssFix& s) { return s.time_s > 125 && s.time_s < 127; });
  PrepareOptions options = Options();
  options.longest_slice_s = 4.0;
  const auto dataset = Prepare(recording, Vehicle{}, options);
  ASSERT_TRUE(dataset);
  std::size_t next = 0;
  std::size_t slice = 0;
  for (const RowRange& segment : dataset->segments) {
    ASSERT_EQ(segment.begin, next);
    for (; slice < dataset->slices.size() && dataset->slices[slice].begin < segment.end; ++slice) {
      const RowRange& range = dataset->slices[slice];
      ASSERT_EQ(range.begin, next);
      ASSERT_LE(range.end, segment.end);
      ASSERT_LE(range.size(), 20u);
      for (std::size_t row = range.begin; row < range.end; ++row) {
        const double t = dataset->rows[row].time_s - 100.0;
        const double phase = std::fmod(t + 0.1, 14.0);  // middle of the row's interval
        ASSERT_EQ(dataset->rows[row].region,
                  phase < 7.0 ? PropellerRegion::kFF : PropellerRegion::kRF)
            << "at " << t;
      }
      next = range.end;
    }
  }
  EXPECT_EQ(next, dataset->rows.size());
}

// du/dt = (K delta - u) / T along north, commands held between random switches: the mean of
// (u(k+1) - u(k)) / h - (K delta(k) - u) / T must vanish for the pairing of command and velocity to
// be unbiased, and fitting K and T by least squares must give them back.
struct FirstOrder {
  double gain = 1.5;
  double time_constant_s = 4.0;
  double noise_m = 0.0;

  Recording Record(std::vector<double>& truth) const;
};

Recording FirstOrder::Record(std::vector<double>& truth) const {
  constexpr double kStep = 0.01;
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  const NorthEastFrame frame(kOrigin);
  Recording recording;
  double x = 0.0;
  double u = 0.0;
  double delta = 0.5;
  for (int i = 0; i <= 60000; ++i) {
    const double t = kStep * i;
    if (i % 10 == 0) {
      if (engine() % 30 == 0) delta = 0.1 + 0.9 * static_cast<double>(engine() % 1000) / 1000.0;
      recording.thrusters.push_back({t, 1500 + 400 * delta, 1500 + 400 * delta});
    }
    if (i % 20 == 0) {
      const auto p = frame.Inverse({x + noise_m * noise(engine), noise_m * noise(engine)});
      recording.gnss.push_back({t, p.latitude_deg, p.longitude_deg});
      truth.push_back(u);
    }
    if (i % 2 == 0) recording.heading.push_back({t, 0.0});
    const double settled = gain * delta;
    const double decay = std::exp(-kStep / time_constant_s);
    x += settled * kStep + (u - settled) * time_constant_s * (1.0 - decay);
    u = settled + (u - settled) * decay;
  }
  return recording;
}

TEST(PrepareRobust, PairsTheCommandWithTheVelocityChangeItCauses) {
  const FirstOrder boat;
  std::vector<double> truth;
  const auto dataset = Prepare(boat.Record(truth), Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  const double h = dataset->sampling_period_s;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double residual = 0.0;
  for (std::size_t k = 0; k + 1 < dataset->rows.size(); ++k) {
    const Eigen::Vector2d phi(dataset->rows[k].delta.port, dataset->rows[k].nu.u);
    const double y = (dataset->rows[k + 1].nu.u - dataset->rows[k].nu.u) / h;
    normal += phi * phi.transpose();
    right += phi * y;
    // The exact discrete model of held commands: (1 - exp(-h / T)) / h instead of 1 / T.
    const double a = (1.0 - std::exp(-h / boat.time_constant_s)) / h;
    residual = std::max(residual, std::abs(y - a * (boat.gain * phi(0) - phi(1))));
  }
  // Commands switch at any tenth, so half of them within an interval, where the mean command over
  // the interval is off by at most h / (4 T) of the step.
  EXPECT_LT(residual, 0.01);
  const Eigen::Vector2d theta = normal.ldlt().solve(right);
  const double a = (1.0 - std::exp(-h / boat.time_constant_s)) / h;
  EXPECT_NEAR(-theta(1), a, 0.005 * a);
  EXPECT_NEAR(theta(0), a * boat.gain, 0.005 * a * boat.gain);
}

TEST(Prepare, RefusesAnEmptyChannelByName) {
  const Recording whole = Record({.pose = Circle(1, 0, 0.1)});
  for (const Channel channel : kChannels) {
    Recording recording = whole;
    if (channel == Channel::kGnss) recording.gnss.clear();
    if (channel == Channel::kHeading) recording.heading.clear();
    if (channel == Channel::kThrusters) recording.thrusters.clear();
    const auto dataset = Prepare(recording, Vehicle{}, PrepareOptions::Robust());
    ASSERT_FALSE(dataset);
    EXPECT_THAT(dataset.error().reason, HasSubstr(std::string(Name(channel))));
    EXPECT_FALSE(dataset.error().advice.empty());
  }
}

TEST(Prepare, RefusesWhenNothingIsLongEnough) {
  const auto dataset = Prepare(Record({.pose = Circle(1, 0, 0.1), .duration_s = 3.0}), Vehicle{},
                               PrepareOptions::Robust());
  ASSERT_FALSE(dataset);
  EXPECT_THAT(dataset.error().reason, HasSubstr("lasts 3 s"));
}

TEST(Prepare, RefusesOneSampleAChannel) {
  Recording recording = Record({.pose = Circle(1, 0, 0.1)});
  recording.gnss.resize(1);
  recording.heading.resize(1);
  recording.thrusters.resize(1);
  EXPECT_FALSE(Prepare(recording, Vehicle{}, PrepareOptions::Robust()));
}

TEST(WhyNotPrepared, SaysWhatPrepareDoes) {
  const auto circle = [](double duration_s) {
    return Record({.pose = Circle(1, 0, 0.1), .duration_s = duration_s});
  };
  Recording silent = circle(30.0);
  silent.heading.clear();
  // A compass that measures every 2.5 s, whose log holds its last reading.
  Recording slow = circle(60.0);
  for (std::size_t i = 0; i < slow.heading.size(); ++i) {
    slow.heading[i].heading_deg = slow.heading[i - i % 125].heading_deg;
  }
  PrepareOptions out_of_range = PrepareOptions::Robust();
  out_of_range.longest_gap_s = -1.0;
  for (const Recording& recording : {circle(3.0), circle(30.0), silent, slow}) {
    for (const PrepareOptions& options :
         {PrepareOptions::Robust(), PrepareOptions::Paper(), out_of_range}) {
      const auto dataset = Prepare(recording, Vehicle{}, options);
      const auto why_not = WhyNotPrepared(recording, options);
      ASSERT_EQ(why_not.has_value(), !dataset.has_value());
      if (why_not) {
        EXPECT_EQ(why_not->reason, dataset.error().reason);
      }
    }
  }
}

TEST(Prepare, AcceptsRepeatedPositions) {
  const auto pose = [](double) { return Pose{3.0, 4.0, 1.0}; };
  const auto dataset = Prepare(Record({.pose = pose}), Vehicle{}, PrepareOptions::Robust());
  ASSERT_TRUE(dataset);
  ExpectVelocities(*dataset, {0.0, 0.0, 0.0}, 1e-9);
}

TEST(PrepareOptions, NameFieldValueAndRange) {
  EXPECT_FALSE(PrepareOptions::Paper().Validate());
  EXPECT_FALSE(PrepareOptions::Robust().Validate());
  EXPECT_THAT(PrepareOptions{.sampling_period_s = 3.0}.Validate()->reason,
              HasSubstr("sampling_period_s = 3 must be within [0.02, 2]"));
  EXPECT_TRUE(PrepareOptions{.preset = Preset::kUnknown}.Validate());
  EXPECT_TRUE(PrepareOptions{.smoothing_half_width = 1}.Validate());
  EXPECT_TRUE((PrepareOptions{.smoothing_half_width = 2, .smoothing_degree = 5}.Validate()));
  EXPECT_TRUE(PrepareOptions{.longest_gap_s = 0.01}.Validate());
  EXPECT_TRUE(PrepareOptions{.shortest_segment_s = 0.5}.Validate());
  EXPECT_TRUE(PrepareOptions{.longest_slice_s = 1.0}.Validate());
  EXPECT_FALSE(Prepare({}, {}, PrepareOptions{.longest_gap_s = -1.0}));
}

}  // namespace
}  // namespace telltale
