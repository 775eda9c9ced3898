#include "telltale/core/data/check/constant_angle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/format_number.hpp"

namespace telltale {
namespace {

constexpr double kSpreadHeadings = 0.8;  // resultant length below which headings lie all around
constexpr double kConcentrated = 0.7;    // resultant length of courses that follow headings
constexpr double kConstantAngleDeg = 15.0;
constexpr double kSureErrors = 4.0;

/// Course less heading while the boat drives ahead, beside its yaw rate.
struct Course {
  double psi_rad = 0.0;
  double drift_rad = 0.0;  ///< course - heading, [-pi, pi]
  double yaw_rate = 0.0;
};

std::vector<Course> CoursesAhead(const RecordedMotion& motion) {
  const HeadingSeries psi = motion.Psi();
  LaggedCommands commands = motion.CommandsAtSpeed();
  std::vector<Course> courses;
  for (const Velocity& v : motion.Velocities()) {
    const bool is_ahead = std::hypot(v.north_mps, v.east_mps) > RecordedMotion::kSlowest &&
                          commands.At(v.time_s).Mean() > RecordedMotion::kAhead &&
                          psi.Covers(v.time_s);
    if (!is_ahead) continue;
    const double angle = psi.At(v.time_s);
    const double drift =
        std::remainder(std::atan2(v.east_mps, v.north_mps) - angle, 2.0 * std::numbers::pi);
    const double rate = psi.At(v.time_s + 0.5 * RecordedMotion::kChordS) -
                        psi.At(v.time_s - 0.5 * RecordedMotion::kChordS);
    courses.push_back({angle, drift, rate / RecordedMotion::kChordS});
  }
  return courses;
}

template <class Angle>
std::complex<double> MeanDirection(const std::vector<Course>& courses, Angle angle) {
  std::complex<double> sum = 0.0;
  for (const Course& course : courses) sum += std::polar(1.0, angle(course));
  return sum / static_cast<double>(std::max<std::size_t>(1, courses.size()));
}

}  // namespace

std::optional<Refusal> ConstantAngle(const RecordedMotion& motion) {
  const std::vector<Course> courses = CoursesAhead(motion);
  const double effective = static_cast<double>(courses.size()) * RecordedMotion::kChordS /
                           (2.0 * RecordedMotion::kSpeedLagS);
  const auto headings = MeanDirection(courses, [](const Course& c) { return c.psi_rad; });
  const auto drift = MeanDirection(courses, [](const Course& c) { return c.drift_rad; });
  if (effective < RecordedMotion::kFewestEffective || std::abs(headings) > kSpreadHeadings ||
      std::abs(drift) < kConcentrated) {
    return std::nullopt;
  }
  // drift = angle + k r: a boat that turns slides outwards.
  double n = 0.0, r = 0.0, rr = 0.0, d = 0.0, dr = 0.0;
  const double centre = std::arg(drift);
  const auto about_centre = [&](const Course& c) {
    return std::remainder(c.drift_rad - centre, 2.0 * std::numbers::pi);
  };
  for (const Course& c : courses) {
    n += 1.0;
    r += c.yaw_rate;
    rr += c.yaw_rate * c.yaw_rate;
    d += about_centre(c);
    dr += about_centre(c) * c.yaw_rate;
  }
  const double determinant = n * rr - r * r;
  if (determinant <= 1e-9 * n * rr) return std::nullopt;
  const double offset = (rr * d - r * dr) / determinant;
  const double slope = (n * dr - r * d) / determinant;
  double square = 0.0;
  for (const Course& c : courses) {
    square += std::pow(about_centre(c) - offset - slope * c.yaw_rate, 2);
  }
  const double error = std::sqrt(square / n * (n * rr / determinant) / effective);
  const double angle_deg = (centre + offset) / kRadiansPerDegree;
  if (std::abs(angle_deg) < std::max(kConstantAngleDeg, kSureErrors * error / kRadiansPerDegree)) {
    return std::nullopt;
  }
  const std::string angle = FormatNumber(angle_deg, 0);
  return Refusal{"heading",
                 "headings seem to be magnetic, or the compass to be turned: over headings all "
                 "around the course keeps " +
                     angle + " ± " + FormatNumber(error / kRadiansPerDegree, 0) +
                     " degrees from the heading",
                 "add " + angle + " degrees to the headings, or the declination of the place"};
}

}  // namespace telltale
