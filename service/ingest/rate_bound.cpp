#include "telltale/service/ingest/rate_bound.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace telltale {
namespace {

using std::chrono::duration;

constexpr ChannelShares kAll = {1.0, 1.0, 1.0};
constexpr duration<double> kPeriod{1.0};
constexpr std::chrono::seconds kQuiet{10};

struct Step {
  Channel channel;
  double least;  ///< share
};

// A model needs commands most: a position or a heading that is missing can be interpolated.
constexpr std::array kSteps = {Step{Channel::kHeading, 0.1}, Step{Channel::kGnss, 0.2},
                               Step{Channel::kThrusters, 0.5}};

double TakenIn(const ChannelShares& shares, const ChannelCounts& arriving) {
  return std::inner_product(shares.begin(), shares.end(), arriving.begin(), 0.0);
}

}  // namespace

ChannelShares SharesWithin(double most, const ChannelCounts& arriving) {
  ChannelShares shares = kAll;
  for (const auto& [channel, least] : kSteps) {
    const auto i = static_cast<std::size_t>(channel);
    const double excess = TakenIn(shares, arriving) - most;
    if (excess <= 0.0) return shares;
    if (arriving[i] == 0) continue;
    shares[i] = std::max(least, 1.0 - excess / static_cast<double>(arriving[i]));
  }
  const double factor = std::min(1.0, most / TakenIn(shares, arriving));
  for (double& share : shares) share *= factor;
  return shares;
}

RateBound::RateBound(double most_per_s) : most_per_s_(most_per_s), shares_(kAll) {}

RateBound::Change RateBound::Count(Channel channel, Clock::time_point now) {
  if (since_ == Clock::time_point()) since_ = now;
  ++counts_[static_cast<std::size_t>(channel)];
  ++counted_;
  const bool is_due = now - since_ >= kPeriod || counted_ >= most_per_s_ * kPeriod.count();
  return is_due && now > since_ ? Renew(now) : Change::kNone;
}

RateBound::Change RateBound::Renew(Clock::time_point now) {
  const double elapsed_s = duration<double>(now - since_).count();
  arriving_per_s_ = counted_ / elapsed_s;
  shares_ = SharesWithin(most_per_s_ * elapsed_s, counts_);
  since_ = now;
  counts_ = {};
  counted_ = 0.0;
  if (shares_ != kAll) {
    thinned_at_ = now;
    return std::exchange(thins_, true) ? Change::kNone : Change::kBeginsToThin;
  }
  if (!thins_ || now - thinned_at_ < kQuiet) return Change::kNone;
  thins_ = false;
  return Change::kEndsToThin;
}

}  // namespace telltale
