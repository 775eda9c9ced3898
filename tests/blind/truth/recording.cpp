#include "recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

#include "degree.hpp"

namespace blind::truth {
namespace {

constexpr int kStepsPerFix = 40;       // 5 Hz
constexpr int kStepsPerHeading = 10;   // 20 Hz
constexpr int kCommandsPerSample = 5;  // 10 Hz

/// North and east metres to degrees around a point of the Baltic, on WGS 84.
class Chart {
 public:
  Chart() {
    constexpr double kEquatorRadiusM = 6378137.0, kEccentricitySquared = 6.69437999014e-3;
    const double sine = std::sin(kLatitudeDeg * kDegree);
    const double w = 1.0 - kEccentricitySquared * sine * sine;
    north_m_per_deg_ = kDegree * kEquatorRadiusM * (1.0 - kEccentricitySquared) / std::pow(w, 1.5);
    east_m_per_deg_ = kDegree * kEquatorRadiusM / std::sqrt(w) * std::cos(kLatitudeDeg * kDegree);
  }
  double LatitudeDeg(double north_m) const { return kLatitudeDeg + north_m / north_m_per_deg_; }
  double LongitudeDeg(double east_m) const { return kLongitudeDeg + east_m / east_m_per_deg_; }

 private:
  static constexpr double kLatitudeDeg = 54.41;
  static constexpr double kLongitudeDeg = 10.22;
  double north_m_per_deg_;
  double east_m_per_deg_;
};

template <typename... Numbers>
void AppendLine(std::string& text, const char* format, Numbers... numbers) {
  std::array<char, 96> line{};
  std::snprintf(line.data(), line.size(), format, numbers...);
  text += line.data();
}

const Faults& FaultsAt(const SimulatedRun& simulated_run, double time_s) {
  return (time_s >= simulated_run.onset_s ? simulated_run.after : simulated_run.before).faults;
}

/// What a compass beside iron shows of a heading: the bearing of the field that it feels.
double Shown(double heading_rad, const Faults& faults) {
  const double forward = std::cos(heading_rad), starboard = -std::sin(heading_rad);
  const double c = std::cos(faults.soft_iron_rad), s = std::sin(faults.soft_iron_rad);
  const double along = faults.soft_iron * (c * forward + s * starboard);
  const double shown = std::atan2(-(starboard + s * along + faults.hard_iron_starboard),
                                  forward + c * along + faults.hard_iron_forward);
  return heading_rad + std::remainder(shown - heading_rad, 360.0 * kDegree);
}

/// The hull's clocks, each a few milliseconds off on that day.
Clocks ClocksOfDay(const Hull& hull, RandomStream rng) {
  constexpr double kFromDayToDayS = 0.005;
  return {.commands_s = hull.clocks.commands_s + rng.Normal(kFromDayToDayS),
          .fixes_s = hull.clocks.fixes_s + rng.Normal(kFromDayToDayS),
          .headings_s = hull.clocks.headings_s + rng.Normal(kFromDayToDayS)};
}

std::string Fixes(const Track& track, const SimulatedRun& simulated_run, double start_s,
                  RandomStream rng) {
  constexpr double kFixDriftTimeS = 20.0;
  const Chart chart;
  const double memory_s = rng.Uniform(20.0, 40.0);
  GaussMarkov north_drift(0.015, memory_s, rng.For("north"));
  GaussMarkov east_drift(0.015, memory_s, rng.For("east"));
  GaussMarkov north_fix_drift(1.0, kFixDriftTimeS, rng.For("north fix drift"));
  GaussMarkov east_fix_drift(1.0, kFixDriftTimeS, rng.For("east fix drift"));
  std::string text = "time_s,latitude_deg,longitude_deg\n";
  for (int step = 0; step < static_cast<int>(track.states.size()); step += kStepsPerFix) {
    const double time = step * kStepS;
    const Faults& faults = FaultsAt(simulated_run, time);
    const int late = static_cast<int>(std::lround(faults.gnss_latency_s / kStepS));
    const State& boat = track.states[static_cast<std::size_t>(std::max(0, step - late))];
    const Hull& hull = simulated_run.before.hull;
    const double forward = hull.antenna_forward_m + faults.antenna_forward_m;
    const double starboard = hull.antenna_starboard_m + faults.antenna_starboard_m;
    const double c = std::cos(boat.heading_rad), s = std::sin(boat.heading_rad);
    const double north = boat.north_m + c * forward - s * starboard + rng.Normal(0.01) +
                         north_drift.Step(kStepsPerFix * kStepS) +
                         faults.fix_drift_m * north_fix_drift.Step(kStepsPerFix * kStepS);
    const double east = boat.east_m + s * forward + c * starboard + rng.Normal(0.01) +
                        east_drift.Step(kStepsPerFix * kStepS) +
                        faults.fix_drift_m * east_fix_drift.Step(kStepsPerFix * kStepS);
    AppendLine(text, "%.6f,%.10f,%.10f\n", start_s + time, chart.LatitudeDeg(north),
               chart.LongitudeDeg(east));
  }
  return text;
}

std::string Headings(const Track& track, const SimulatedRun& simulated_run, double start_s,
                     RandomStream rng) {
  constexpr double kHeadingDriftTimeS = 25.0;
  GaussMarkov drift(0.15 * kDegree, rng.Uniform(20.0, 40.0), rng.For("drift"));
  GaussMarkov applied_drift(1.0, kHeadingDriftTimeS, rng.For("wander"));
  std::string text = "time_s,heading_deg\n";
  for (int step = 0; step < static_cast<int>(track.states.size()); step += kStepsPerHeading) {
    const double time = step * kStepS;
    const Faults& faults = FaultsAt(simulated_run, time);
    const double shown = Shown(track.states[static_cast<std::size_t>(step)].heading_rad, faults) +
                         faults.heading_bias_rad + rng.Normal(0.2 * kDegree) +
                         drift.Step(kStepsPerHeading * kStepS) +
                         faults.heading_drift_rad * applied_drift.Step(kStepsPerHeading * kStepS);
    double degrees = std::fmod(shown / kDegree, 360.0);
    if (degrees < 0.0) degrees += 360.0;
    AppendLine(text, "%.6f,%.4f\n", start_s + time, degrees);
  }
  return text;
}

std::string Commands(const Track& track, double start_s) {
  std::string text = "time_s,left_us,right_us\n";
  for (std::size_t at = 0; at < track.commands.size(); at += kCommandsPerSample) {
    AppendLine(text, "%.6f,%.0f,%.0f\n",
               start_s + static_cast<double>(at) * kStepsPerCommand * kStepS,
               track.commands[at].port_us, track.commands[at].starboard_us);
  }
  return text;
}

}  // namespace

void WriteFile(const std::filesystem::path& file, const std::string& content) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << content;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
}

void WriteRecording(const Track& track, const SimulatedRun& simulated_run, std::size_t day,
                    RandomStream rng, const std::filesystem::path& folder) {
  constexpr double kFirstMorningS = 1717221600.0;
  constexpr double kDayS = 86400.0;
  const double start = kFirstMorningS + kDayS * static_cast<double>(day);
  const Clocks clocks = ClocksOfDay(simulated_run.before.hull, rng.For("clocks"));
  WriteFile(folder / "gnss.csv",
            Fixes(track, simulated_run, start + clocks.fixes_s, rng.For("fixes")));
  WriteFile(folder / "heading.csv",
            Headings(track, simulated_run, start + clocks.headings_s, rng.For("headings")));
  WriteFile(folder / "thrusters.csv", Commands(track, start + clocks.commands_s));
}

}  // namespace blind::truth
