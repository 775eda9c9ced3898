#include "telltale/core/data/check/recorded_motion.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/data/north_east_frame.hpp"

namespace telltale {
namespace {

PropellerCommand Between(const PropellerCommand& from, const PropellerCommand& to, double share) {
  return {from.port + share * (to.port - from.port),
          from.starboard + share * (to.starboard - from.starboard)};
}

std::vector<Velocity> VelocitiesOf(const std::vector<GnssFix>& gnss) {
  std::vector<Velocity> velocities;
  if (gnss.empty()) return velocities;
  const NorthEastFrame frame({gnss.front().latitude_deg, gnss.front().longitude_deg});
  for (std::size_t i = 0, j = 0; j < gnss.size(); ++j) {
    const double span_s = gnss[j].time_s - gnss[i].time_s;
    if (span_s < RecordedMotion::kChordS) continue;
    if (span_s < RecordedMotion::kWidestChordS) {
      const auto from = frame.Forward({gnss[i].latitude_deg, gnss[i].longitude_deg});
      const auto to = frame.Forward({gnss[j].latitude_deg, gnss[j].longitude_deg});
      velocities.push_back({0.5 * (gnss[i].time_s + gnss[j].time_s), span_s,
                            (to.north_m - from.north_m) / span_s,
                            (to.east_m - from.east_m) / span_s});
    }
    i = j;
  }
  return velocities;
}

}  // namespace

LaggedCommands::LaggedCommands(const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle,
                               double lag_s)
    : thrusters_(thrusters), vehicle_(vehicle), lag_s_(lag_s), told_(Told(0)), next_(told_) {}

PropellerCommand LaggedCommands::At(double t) {
  while (at_ < thrusters_.size() && thrusters_[at_].time_s <= t) Advance();
  if (at_ == 0) return next_;
  if (at_ == thrusters_.size()) return last_;
  const double since_s = thrusters_[at_ - 1].time_s;
  return Between(last_, next_, (t - since_s) / (thrusters_[at_].time_s - since_s));
}

PropellerCommand LaggedCommands::Told(std::size_t i) const {
  return vehicle_.Normalise(thrusters_[i].port_us, thrusters_[i].starboard_us);
}

void LaggedCommands::Advance() {
  last_ = next_;
  if (++at_ == thrusters_.size()) return;
  const double held_s = thrusters_[at_].time_s - thrusters_[at_ - 1].time_s;
  next_ = Between(told_, last_, std::exp(-held_s / lag_s_));
  told_ = Told(at_);
}

double HeadingSeries::At(double t) const {
  if (t <= StartTime()) return psi_rad_.front();
  if (t >= EndTime()) return psi_rad_.back();
  const std::size_t right = LaterThan(t);
  const double since_s = heading_[right - 1].time_s;
  const double share = (t - since_s) / (heading_[right].time_s - since_s);
  return psi_rad_[right - 1] + share * (psi_rad_[right] - psi_rad_[right - 1]);
}

std::size_t HeadingSeries::LaterThan(double t) const {
  const auto later = std::ranges::upper_bound(heading_, t, {}, &HeadingSample::time_s);
  return static_cast<std::size_t>(later - heading_.begin());
}

RecordedMotion::RecordedMotion(const std::vector<GnssFix>& gnss,
                               const std::vector<HeadingSample>& heading,
                               const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle)
    : heading_(heading), thrusters_(thrusters), vehicle_(vehicle), velocities_(VelocitiesOf(gnss)) {
  for (const Velocity& velocity : velocities_) moving_s_ += velocity.span_s;
  for (std::size_t i = 1; i < heading.size(); ++i) {
    const double span_s = heading[i].time_s - heading[i - 1].time_s;
    if (span_s <= kWidestChordS) turning_s_ += span_s;
  }
}

}  // namespace telltale
