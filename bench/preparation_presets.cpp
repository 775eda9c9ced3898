// Velocity errors of the two preparation presets on a known motion: the table of
// docs/concepts/data-preparation.md. With --sweep also the robust preset over half widths and
// degrees.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include "telltale/core/base/random.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/preparation.hpp"

namespace {

using namespace telltale;

constexpr double kStepS = 0.001;
constexpr double kDurationS = 600.0;
constexpr double kStartS = 1000.0;
constexpr FrameOrigin kOrigin{37.4205, -5.9944};
constexpr double kSurgeTimeConstantS = 3.0;
constexpr double kSurgeGain = 1.6;

struct Noise {
  const char* name;
  double position_m;
  double heading_deg;
};

struct Clocks {
  const char* name;
  double heading_offset_s;
  double thruster_offset_s;
  double jitter_s;
};

struct Motion {
  std::vector<Nu> nu;
  std::vector<Eta> eta;
  std::vector<PropellerCommand> delta;
};

/// Random held commands, each side changing every two to eight seconds, drive first-order surge,
/// yaw and sway; sway follows the turn as a skidding hull does.
Motion Move(std::uint64_t seed) {
  RandomEngine engine(seed);
  boost::random::uniform_real_distribution<double> hold(2.0, 8.0);
  boost::random::uniform_real_distribution<double> command(-0.3, 1.0);
  constexpr double kYawTimeConstantS = 1.0;
  constexpr double kSwayTimeConstantS = 1.5;
  Motion motion;
  Nu nu;
  Eta eta;
  PropellerCommand delta;
  double port_until = 0.0;
  double starboard_until = 0.0;
  for (double t = 0.0; t < kDurationS; t += kStepS) {
    if (t >= port_until) {
      delta.port = command(engine);
      port_until = t + hold(engine);
    }
    if (t >= starboard_until) {
      delta.starboard = command(engine);
      starboard_until = t + hold(engine);
    }
    motion.nu.push_back(nu);
    motion.eta.push_back(eta);
    motion.delta.push_back(delta);
    const Eigen::Vector3d eta_dot = EtaDot(eta.psi_rad, nu);
    eta.x_m += kStepS * eta_dot(0);
    eta.y_m += kStepS * eta_dot(1);
    eta.psi_rad += kStepS * eta_dot(2);
    nu.u += kStepS * (kSurgeGain * delta.Mean() - nu.u) / kSurgeTimeConstantS;
    nu.r += kStepS * (0.8 * delta.Difference() - nu.r) / kYawTimeConstantS;
    nu.v += kStepS * (-0.3 * nu.u * nu.r - nu.v) / kSwayTimeConstantS;
  }
  return motion;
}

/// Calls take(time, index into the motion) at every `period` from `offset` on.
template <class Take>
void Sample(const Motion& motion, double period, double offset, double jitter, RandomEngine& engine,
            Take take) {
  boost::random::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0;; ++i) {
    const double t = std::max(0.0, offset + i * period + jitter * unit(engine));
    const auto index = static_cast<std::size_t>(std::lround(t / kStepS));
    if (index >= motion.eta.size()) return;
    take(kStartS + static_cast<double>(index) * kStepS, index);
  }
}

Recording Measure(const Motion& motion, const Noise& noise, const Clocks& clocks,
                  std::uint64_t seed) {
  RandomEngine engine(seed);
  boost::random::normal_distribution<double> normal;
  const NorthEastFrame frame(kOrigin);
  const PwmChannel channel;
  Recording recording;
  Sample(motion, 0.2, 0.0, clocks.jitter_s, engine, [&](double t, std::size_t i) {
    const auto p = frame.Inverse({motion.eta[i].x_m + noise.position_m * normal(engine),
                                  motion.eta[i].y_m + noise.position_m * normal(engine)});
    recording.gnss.push_back({t, p.latitude_deg, p.longitude_deg});
  });
  Sample(motion, 0.02, clocks.heading_offset_s, clocks.jitter_s / 10.0, engine,
         [&](double t, std::size_t i) {
           const double psi_deg = motion.eta[i].psi_rad * 180.0 / std::numbers::pi;
           const double heading = psi_deg + noise.heading_deg * normal(engine);
           recording.heading.push_back({t, heading - 360.0 * std::floor(heading / 360.0)});
         });
  Sample(motion, 0.1, clocks.thruster_offset_s, clocks.jitter_s, engine,
         [&](double t, std::size_t i) {
           recording.thrusters.push_back({t, channel.PulseWidth(motion.delta[i].port),
                                          channel.PulseWidth(motion.delta[i].starboard)});
         });
  return recording;
}

struct Score {
  double u = 0.0;
  double v = 0.0;
  double r = 0.0;
  double gain_percent = 0.0;
};

/// RMS errors of the velocities, and the error of the surge gain that one-step least squares gets.
Score ScorePreparation(const PreparedDataset& dataset, const Motion& motion) {
  Score sum;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  const double h = dataset.sampling_period_s;
  for (std::size_t k = 0; k + 1 < dataset.rows.size(); ++k) {
    const PreparedRow& row = dataset.rows[k];
    const auto i = static_cast<std::size_t>(std::lround((row.time_s - kStartS) / kStepS));
    const Nu& truth = motion.nu[std::min(i, motion.nu.size() - 1)];
    sum.u += std::pow(row.nu.u - truth.u, 2);
    sum.v += std::pow(row.nu.v - truth.v, 2);
    sum.r += std::pow(row.nu.r - truth.r, 2);
    const Eigen::Vector2d phi(row.delta.Mean(), row.nu.u);
    normal += phi * phi.transpose();
    right += phi * (dataset.rows[k + 1].nu.u - row.nu.u) / h;
  }
  const auto n = static_cast<double>(dataset.rows.size() - 1);
  const double expected =
      kSurgeGain * (1.0 - std::exp(-h / kSurgeTimeConstantS)) / h;  // of the discrete model
  return {std::sqrt(sum.u / n), std::sqrt(sum.v / n), std::sqrt(sum.r / n),
          100.0 * (normal.ldlt().solve(right)(0) / expected - 1.0)};
}

constexpr std::array kNoises = {Noise{"none", 0.0, 0.0}, Noise{"RTK: 1.5 cm, 0.2 deg", 0.015, 0.2},
                                Noise{"plain: 10 cm, 0.5 deg", 0.10, 0.5}};
constexpr std::array kClocks = {Clocks{"aligned", 0.0, 0.0, 0.0},
                                Clocks{"unaligned", 0.013, 0.057, 0.02}};

void PrintRow(const char* preset, const PrepareOptions& options, const Noise& noise,
              const Clocks& clocks, const Motion& motion) {
  const auto dataset = Prepare(Measure(motion, noise, clocks, 2), Vehicle{}, options);
  if (!dataset) {
    std::printf("| %s | %s | %s | refused: %s |\n", preset, noise.name, clocks.name,
                dataset.error().reason.c_str());
    return;
  }
  const Score score = ScorePreparation(*dataset, motion);
  std::printf("| %s | %zu / %zu | %s | %s | %.4f | %.4f | %.4f | %+.1f %% |\n", preset,
              options.smoothing_half_width, options.smoothing_degree, noise.name, clocks.name,
              score.u, score.v, score.r, score.gain_percent);
}

void PrintPresets(const Motion& motion) {
  for (const Noise& noise : kNoises) {
    for (const Clocks& clocks : kClocks) {
      PrintRow("paper", PrepareOptions::Paper(), noise, clocks, motion);
      PrintRow("robust", PrepareOptions::Robust(), noise, clocks, motion);
    }
  }
}

void PrintSweep(const Motion& motion) {
  for (const Noise& noise : kNoises) {
    for (const std::size_t degree : {2u, 3u, 5u}) {
      for (const std::size_t half_width : {3u, 4u, 5u, 6u, 8u, 10u}) {
        PrepareOptions options = PrepareOptions::Robust();
        options.smoothing_degree = degree;
        options.smoothing_half_width = half_width;
        PrintRow("robust", options, noise, kClocks[1], motion);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Motion motion = Move(1);
  std::printf(
      "| preset | half width / degree | noise | clocks | u m/s | v m/s | r rad/s | gain |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  PrintPresets(motion);
  if (argc > 1 && std::strcmp(argv[1], "--sweep") == 0) PrintSweep(motion);
}
