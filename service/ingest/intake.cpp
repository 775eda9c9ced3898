#include "telltale/service/ingest/intake.hpp"

#include <spdlog/spdlog.h>

namespace telltale {
namespace {

const std::string kFleet = "the fleet";

}  // namespace

Intake::Intake(const IntakeLimits& limits)
    : limits_(limits), total_(limits.samples_per_s), log_limit_(5, std::chrono::seconds(10)) {}

bool Intake::Admits(Stream& stream, const std::string& vehicle_id, Channel channel,
                    Clock::time_point now) {
  return Passes(stream.bound, stream.by_own_bound, channel, now, vehicle_id) &&
         Passes(total_, stream.by_total, channel, now, kFleet);
}

bool Intake::Passes(RateBound& bound, ChannelThinners& thinners, Channel channel,
                    Clock::time_point now, const std::string& sender) {
  Tell(bound.Count(channel, now), bound, sender, now);
  return thinners[static_cast<std::size_t>(channel)].Keep(bound.ShareOf(channel));
}

void Intake::Tell(RateBound::Change change, const RateBound& bound, const std::string& sender,
                  Clock::time_point now) {
  if (change == RateBound::Change::kNone) return;
  const auto not_shown = log_limit_.Admit(now);
  if (!not_shown) return;
  if (change == RateBound::Change::kBeginsToThin) {
    spdlog::warn(
        "{} sends {:.0f} samples/s, and {:.0f} are taken in: headings are thinned first, then "
        "positions, then commands ({} more not shown)",
        sender, bound.arriving_per_s(), bound.most_per_s(), *not_shown);
  } else {
    spdlog::info("all that {} sends is taken in again ({} more not shown)", sender, *not_shown);
  }
}

}  // namespace telltale
