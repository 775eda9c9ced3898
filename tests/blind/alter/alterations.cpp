#include "alter/alterations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace blind::alter {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The heading at a time by linear interpolation the short way round; nothing outside the headings.
std::optional<double> HeadingAt(const std::vector<Heading>& headings, double time_s) {
  const auto after =
      std::lower_bound(headings.begin(), headings.end(), time_s,
                       [](const Heading& row, double time) { return row.time_s < time; });
  if (after == headings.end()) return std::nullopt;
  if (after->time_s == time_s) return after->heading_deg;
  if (after == headings.begin()) return std::nullopt;
  const auto before = after - 1;
  const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
  return before->heading_deg +
         share * std::remainder(after->heading_deg - before->heading_deg, 360.0);
}

/// Metres north and east of a degree at a latitude, on WGS 84.
struct DegreeLengths {
  double north_m;
  double east_m;
};

DegreeLengths LengthsAt(double latitude_deg) {
  constexpr double kEquatorRadiusM = 6378137.0, kEccentricitySquared = 6.69437999014e-3;
  const double sine = std::sin(latitude_deg * kDegree);
  const double w = 1.0 - kEccentricitySquared * sine * sine;
  return {.north_m = kDegree * kEquatorRadiusM * (1.0 - kEccentricitySquared) / std::pow(w, 1.5),
          .east_m = kDegree * kEquatorRadiusM / std::sqrt(w) * std::cos(latitude_deg * kDegree)};
}

/// The share of full command of a pulse, positive ahead.
double Delta(double pulse_us, const Channel& channel) {
  const double ahead =
      (pulse_us - channel.neutral_us) / (channel.full_forward_us - channel.neutral_us);
  if (ahead >= 0.0) return ahead;
  return -(pulse_us - channel.neutral_us) / (channel.full_reverse_us - channel.neutral_us);
}

double Pulse(double delta, const Channel& channel) {
  const double full = delta >= 0.0 ? channel.full_forward_us : channel.full_reverse_us;
  return channel.neutral_us + std::abs(delta) * (full - channel.neutral_us);
}

/// The command that gives `times` the thrust of `delta`, which may lie beyond +-1.
double CommandForThrust(double delta, double times, const ThrustCurve& curve) {
  const double dead_band = delta > 0.0 ? curve.forward_dead_band : curve.reverse_dead_band;
  const double beyond = std::abs(delta) - dead_band;
  if (beyond <= 0.0) return delta;
  const double linear = delta > 0.0 ? curve.forward_linear : curve.reverse_linear;
  const double quadratic = delta > 0.0 ? curve.forward_quadratic : curve.reverse_quadratic;
  const double thrust = times * (linear + quadratic * beyond) * beyond;
  const double needed =
      2.0 * thrust / (linear + std::sqrt(linear * linear + 4.0 * quadratic * thrust));
  return std::copysign(needed + dead_band, delta);
}

}  // namespace

void TurnHeading(Telemetry& telemetry, double degrees) {
  for (Heading& row : telemetry.headings) {
    const double turned = std::fmod(row.heading_deg + degrees, 360.0);
    row.heading_deg = turned < 0.0 ? turned + 360.0 : turned;
  }
}

void DelayFixes(Telemetry& telemetry, double seconds) {
  for (Fix& fix : telemetry.fixes) fix.time_s += seconds;
}

void ShiftCommands(Telemetry& telemetry, double seconds) {
  for (Pulses& row : telemetry.pulses) row.time_s -= seconds;
}

std::size_t MoveAntenna(Telemetry& telemetry, double forward_m, double starboard_m) {
  std::vector<Fix> moved;
  for (const Fix& fix : telemetry.fixes) {
    const auto heading = HeadingAt(telemetry.headings, fix.time_s);
    if (!heading) continue;
    const double c = std::cos(*heading * kDegree), s = std::sin(*heading * kDegree);
    const DegreeLengths degree = LengthsAt(fix.latitude_deg);
    moved.push_back({fix.time_s,
                     fix.latitude_deg + (c * forward_m - s * starboard_m) / degree.north_m,
                     fix.longitude_deg + (s * forward_m + c * starboard_m) / degree.east_m});
  }
  const std::size_t dropped = telemetry.fixes.size() - moved.size();
  telemetry.fixes = std::move(moved);
  return dropped;
}

std::size_t Weaken(Telemetry& telemetry, Side side, double lost, const Channel& channel,
                   const ThrustCurve& curve) {
  std::size_t cut = 0;
  for (Pulses& row : telemetry.pulses) {
    double& pulse = side == Side::kPort ? row.left_us : row.right_us;
    const double delta = std::clamp(Delta(pulse, channel), -1.0, 1.0);
    const double needed = CommandForThrust(delta, 1.0 / (1.0 - lost), curve);
    cut += std::abs(needed) > 1.0 ? 1 : 0;
    pulse = Pulse(std::clamp(needed, -1.0, 1.0), channel);
  }
  return cut;
}

}  // namespace blind::alter
