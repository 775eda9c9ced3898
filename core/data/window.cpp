#include "telltale/core/data/window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <tuple>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/range.hpp"

namespace telltale {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

// Pulse widths this close to those at the start of a repeated reading command the same motion.
constexpr double kSameCommandUs = 50.0;

// A command's effect is not vouched for beyond this time without a newer one.
constexpr double kLongestHoldS = 1.0;

constexpr Channel ChannelOf(const GnssFix&) {
  return Channel::kGnss;
}
constexpr Channel ChannelOf(const HeadingSample&) {
  return Channel::kHeading;
}
constexpr Channel ChannelOf(const ThrusterSample&) {
  return Channel::kThrusters;
}

bool IsFinite(const GnssFix& s) {
  return std::isfinite(s.time_s) && std::isfinite(s.latitude_deg) && std::isfinite(s.longitude_deg);
}
bool IsFinite(const HeadingSample& s) {
  return std::isfinite(s.time_s) && std::isfinite(s.heading_deg);
}
bool IsFinite(const ThrusterSample& s) {
  return std::isfinite(s.time_s) && std::isfinite(s.port_us) && std::isfinite(s.starboard_us);
}

bool Within(double value, double low, double high) {
  return value >= low && value <= high;
}

bool InRange(const GnssFix& s) {
  return Within(s.latitude_deg, -90.0, 90.0) && Within(s.longitude_deg, -180.0, 180.0);
}
bool InRange(const HeadingSample& s) {
  return Within(s.heading_deg, -360.0, 720.0);
}
bool InRange(const ThrusterSample& s) {
  return Within(s.port_us, 500.0, 2500.0) && Within(s.starboard_us, 500.0, 2500.0);
}

bool SameReading(const GnssFix& a, const GnssFix& b) {
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
}
bool SameReading(const HeadingSample& a, const HeadingSample& b) {
  return a.heading_deg == b.heading_deg;
}

bool SameCommand(const ThrusterSample& a, const ThrusterSample& b) {
  return std::abs(a.port_us - b.port_us) <= kSameCommandUs &&
         std::abs(a.starboard_us - b.starboard_us) <= kSameCommandUs;
}

template <class Channels, class Visit>
void ForEachChannel(Channels& channels, Visit visit) {
  std::apply([&visit](auto&... samples) { (visit(samples), ...); }, channels);
}

/// Watches one sensor for a reading that does not change although the commands did.
template <class Sample>
class StuckWatch {
 public:
  void See(const Sample& sample, const std::optional<ThrusterSample>& command) {
    if (reading_ && SameReading(*reading_, sample)) return;
    reading_ = sample;
    command_then_ = command;
    commanded_s_ = 0.0;
  }

  /// `held` was in force for `duration_s`.
  void Commanded(const ThrusterSample& held, double duration_s) {
    if (!command_then_) command_then_ = held;
    if (!SameCommand(held, *command_then_)) commanded_s_ += std::min(duration_s, kLongestHoldS);
  }

  bool IsStuck(double after_s) const { return commanded_s_ > after_s; }

 private:
  std::optional<Sample> reading_;
  std::optional<ThrusterSample> command_then_;
  double commanded_s_ = 0.0;
};

/// Samples off the window's clock that agree with each other: perhaps the boat's new clock.
class ClockCandidate {
 public:
  /// How many samples in a row now speak for the new clock.
  std::size_t See(Channel channel, double time_s, double consistent_within_s) {
    if (count_ == 0 || std::abs(time_s - latest_s_) > consistent_within_s) Forget();
    double& of_channel = latest_of_[static_cast<std::size_t>(channel)];
    // A stamp that stands still is no clock.
    if (time_s > of_channel) ++count_;
    of_channel = std::max(of_channel, time_s);
    latest_s_ = time_s;
    return count_;
  }

  void Forget() { *this = ClockCandidate(); }

 private:
  std::size_t count_ = 0;
  double latest_s_ = kNever;
  std::array<double, kChannels.size()> latest_of_ = {kNever, kNever, kNever};
};

}  // namespace

std::optional<Refusal> WindowLimits::Validate() const {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  constexpr double kSmallestMemory = 64.0 * 1024.0;
  const std::string_view window = "window";
  if (auto r = OutOfRange(window, "duration_s", duration_s, 10.0, 86400.0)) return r;
  if (auto r = OutOfRange(window, "memory_bytes", static_cast<double>(memory_bytes),
                          kSmallestMemory, kUnbounded)) {
    return r;
  }
  if (auto r = OutOfRange(window, "reorder_tolerance_s", reorder_tolerance_s, 0.0, 10.0)) return r;
  if (auto r = OutOfRange(window, "clock_jump_s", clock_jump_s, 1.0, 86400.0)) return r;
  if (auto r = OutOfRange(window, "clock_jump_confirmations",
                          static_cast<double>(clock_jump_confirmations), 1.0, 1000.0)) {
    return r;
  }
  return OutOfRange(window, "stuck_after_s", stuck_after_s, 1.0, 600.0);
}

struct Window::Impl {
  explicit Impl(WindowLimits window_limits) : limits(window_limits) {}

  template <class Sample>
  std::optional<RejectReason> Add(const Sample& sample) {
    const std::optional<RejectReason> reason = Admit(sample);
    if (reason) rejected.Count(ChannelOf(sample), *reason);
    return reason;
  }

  template <class Sample>
  std::optional<RejectReason> Admit(const Sample& sample) {
    if (!IsFinite(sample)) return RejectReason::kNotFinite;
    if (!InRange(sample)) return RejectReason::kOutOfRange;
    if (Leaps(sample.time_s) && !AcceptClock(ChannelOf(sample), sample.time_s)) {
      return RejectReason::kClockJump;
    }
    if (const auto reason = Insert(sample)) return reason;
    candidate.Forget();
    newest_s = std::max(newest_s, sample.time_s);
    DropExpired();
    return std::nullopt;
  }

  bool Leaps(double time_s) const {
    return !Empty() && std::abs(time_s - newest_s) > limits.clock_jump_s;
  }

  // Ahead, what is held stays: it lies behind a gap, as after a long silence. Back, it lies in the
  // new clock's future and has to go.
  bool AcceptClock(Channel channel, double time_s) {
    if (candidate.See(channel, time_s, limits.clock_jump_s) < limits.clock_jump_confirmations) {
      return false;
    }
    if (time_s < newest_s) Restart();
    return true;
  }

  void Restart() {
    held = {};
    last_command.reset();
    gnss_watch = {};
    heading_watch = {};
    newest_s = kNever;
  }

  template <class Sample>
  std::optional<RejectReason> Insert(const Sample& sample) {
    std::deque<Sample>& samples = std::get<std::deque<Sample>>(held);
    if (samples.empty() || sample.time_s > samples.back().time_s) {
      if (Expired(sample)) return RejectReason::kOutOfOrder;
      if (IsStuck(sample)) return RejectReason::kStuckSensor;
      samples.push_back(sample);
      return std::nullopt;
    }
    return InsertLate(samples, sample);
  }

  template <class Sample>
  std::optional<RejectReason> InsertLate(std::deque<Sample>& samples, const Sample& sample) {
    const auto place =
        std::lower_bound(samples.begin(), samples.end(), sample.time_s,
                         [](const Sample& s, double time_s) { return s.time_s < time_s; });
    if (place->time_s == sample.time_s) return RejectReason::kDuplicate;
    if (samples.back().time_s - sample.time_s > limits.reorder_tolerance_s || Expired(sample)) {
      return RejectReason::kOutOfOrder;
    }
    samples.insert(place, sample);
    return std::nullopt;
  }

  bool IsStuck(const GnssFix& fix) {
    gnss_watch.See(fix, last_command);
    return gnss_watch.IsStuck(limits.stuck_after_s);
  }
  bool IsStuck(const HeadingSample& sample) {
    heading_watch.See(sample, last_command);
    return heading_watch.IsStuck(limits.stuck_after_s);
  }
  bool IsStuck(const ThrusterSample& command) {
    if (last_command) {
      const double held_s = command.time_s - last_command->time_s;
      gnss_watch.Commanded(*last_command, held_s);
      heading_watch.Commanded(*last_command, held_s);
    }
    last_command = command;
    return false;
  }

  template <class Sample>
  bool Expired(const Sample& sample) const {
    return sample.time_s < newest_s - limits.duration_s;
  }

  void DropExpired() {
    ForEachChannel(held, [this](auto& samples) {
      while (!samples.empty() && Expired(samples.front())) samples.pop_front();
    });
    while (StoredBytes() > limits.memory_bytes) DropOldest();
  }

  void DropOldest() {
    const double oldest_s = StartTime();
    ForEachChannel(held, [oldest_s](auto& samples) {
      if (!samples.empty() && samples.front().time_s <= oldest_s) samples.pop_front();
    });
  }

  std::size_t StoredBytes() const {
    return std::get<0>(held).size() * sizeof(GnssFix) +
           std::get<1>(held).size() * sizeof(HeadingSample) +
           std::get<2>(held).size() * sizeof(ThrusterSample);
  }

  double StartTime() const {
    double oldest_s = std::numeric_limits<double>::infinity();
    ForEachChannel(held, [&oldest_s](const auto& samples) {
      if (!samples.empty()) oldest_s = std::min(oldest_s, samples.front().time_s);
    });
    return oldest_s;
  }

  bool Empty() const {
    return std::get<0>(held).empty() && std::get<1>(held).empty() && std::get<2>(held).empty();
  }

  WindowLimits limits;
  std::tuple<std::deque<GnssFix>, std::deque<HeadingSample>, std::deque<ThrusterSample>> held;
  double newest_s = kNever;
  RejectCounts rejected;
  ClockCandidate candidate;
  std::optional<ThrusterSample> last_command;
  StuckWatch<GnssFix> gnss_watch;
  StuckWatch<HeadingSample> heading_watch;
};

Window::Window(WindowLimits limits) {
  Require(!limits.Validate(), "window limits that pass their own validation");
  impl_ = std::make_unique<Impl>(limits);
}

Window::~Window() = default;
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;

std::optional<RejectReason> Window::Add(const GnssFix& fix) {
  return impl_->Add(fix);
}
std::optional<RejectReason> Window::Add(const HeadingSample& sample) {
  return impl_->Add(sample);
}
std::optional<RejectReason> Window::Add(const ThrusterSample& sample) {
  return impl_->Add(sample);
}

Recording Window::Snapshot() const {
  const auto& [gnss, heading, thrusters] = impl_->held;
  return {{gnss.begin(), gnss.end()},
          {heading.begin(), heading.end()},
          {thrusters.begin(), thrusters.end()},
          impl_->rejected};
}

std::size_t Window::Size(Channel channel) const {
  switch (channel) {
    case Channel::kGnss: return std::get<0>(impl_->held).size();
    case Channel::kHeading: return std::get<1>(impl_->held).size();
    case Channel::kThrusters: return std::get<2>(impl_->held).size();
  }
  return 0;
}

double Window::StartTime() const {
  return Empty() ? 0.0 : impl_->StartTime();
}
double Window::EndTime() const {
  return Empty() ? 0.0 : impl_->newest_s;
}
bool Window::Empty() const {
  return impl_->Empty();
}
const RejectCounts& Window::Rejected() const {
  return impl_->rejected;
}

}  // namespace telltale
