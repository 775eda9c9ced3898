#include "telltale/core/data/window.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <tuple>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/range.hpp"
#include "telltale/core/data/check/clock_check.hpp"
#include "telltale/core/data/check/stuck_sensor_check.hpp"

namespace telltale {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

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

bool Allowed(double value, double low, double high) {
  return value >= low && value <= high;
}

bool InRange(const GnssFix& s) {
  return Allowed(s.latitude_deg, -90.0, 90.0) && Allowed(s.longitude_deg, -180.0, 180.0);
}
bool InRange(const HeadingSample& s) {
  return Allowed(s.heading_deg, -360.0, 720.0);
}
bool InRange(const ThrusterSample& s) {
  return Allowed(s.port_us, 500.0, 2500.0) && Allowed(s.starboard_us, 500.0, 2500.0);
}

template <class Channels, class Visit>
void ForEachChannel(Channels& channels, Visit visit) {
  std::apply([&visit](auto&... samples) { (visit(samples), ...); }, channels);
}

template <class Sample>
std::vector<Sample> Since(const std::deque<Sample>& samples, double from_s) {
  const auto first = std::ranges::lower_bound(samples, from_s, {}, &Sample::time_s);
  return {first, samples.end()};
}

/// A deque frees its blocks as it is taken from.
template <class Sample>
std::vector<Sample> Drained(std::deque<Sample>& from) {
  std::vector<Sample> samples;
  samples.reserve(from.size());
  for (; !from.empty(); from.pop_front()) samples.push_back(from.front());
  return samples;
}

}  // namespace

std::optional<Refusal> WindowLimits::Validate() const {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  const std::string_view window = "window";
  if (auto r = OutOfRange(window, "duration_s", duration_s, 10.0, 86400.0)) return r;
  if (auto r = OutOfRange(window, "memory_bytes", static_cast<double>(memory_bytes),
                          static_cast<double>(kLeastMemory), kUnbounded)) {
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
  /// The samples of one clock, and what has been seen of them.
  struct Held {
    std::tuple<std::deque<GnssFix>, std::deque<HeadingSample>, std::deque<ThrusterSample>> samples;
    double newest_s = kNever;
    std::optional<ThrusterSample> last_command;
    StuckSensorCheck<GnssFix> stuck_gnss;
    StuckSensorCheck<HeadingSample> stuck_heading;
  };

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
    if (ClockJumps(sample.time_s) && !AcceptClock(ChannelOf(sample), sample.time_s)) {
      return RejectReason::kClockJump;
    }
    if (const auto reason = Insert(sample)) return reason;
    clock_check.Reset();
    held.newest_s = std::max(held.newest_s, sample.time_s);
    DropExpired();
    SettleClock();
    return std::nullopt;
  }

  bool ClockJumps(double time_s) const {
    return !Empty() && std::abs(time_s - held.newest_s) > limits.clock_jump_s;
  }

  // After a jump ahead the held samples stay: they lie before a gap. After a jump back they lie in
  // the new clock's future and are dropped. Either way the samples of the former clock are kept
  // until the new one has settled: a few forged or faulty stamps confirm a clock, and the boat then
  // goes on by its own.
  bool AcceptClock(Channel channel, double time_s) {
    if (clock_check.Count(channel, time_s, limits.clock_jump_s) < limits.clock_jump_confirmations) {
      return false;
    }
    if (former && std::abs(time_s - former->newest_s) <= limits.clock_jump_s) {
      held = std::move(*former);
      former.reset();
      return true;
    }
    const bool is_back = time_s < held.newest_s;
    if (!former) former = is_back ? std::move(held) : held;
    if (is_back) held = {};
    confirmed_s = time_s;
    return true;
  }

  // The stamps of one burst all lie within clock_jump_s of each other.
  void SettleClock() {
    if (former && held.newest_s - confirmed_s > limits.clock_jump_s) former.reset();
  }

  template <class Sample>
  std::optional<RejectReason> Insert(const Sample& sample) {
    std::deque<Sample>& samples = std::get<std::deque<Sample>>(held.samples);
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
    held.stuck_gnss.AddReading(fix, held.last_command);
    return held.stuck_gnss.IsStuck(limits.stuck_after_s);
  }
  bool IsStuck(const HeadingSample& sample) {
    held.stuck_heading.AddReading(sample, held.last_command);
    return held.stuck_heading.IsStuck(limits.stuck_after_s);
  }
  bool IsStuck(const ThrusterSample& command) {
    if (held.last_command) {
      const double held_s = command.time_s - held.last_command->time_s;
      held.stuck_gnss.AddCommand(*held.last_command, held_s);
      held.stuck_heading.AddCommand(*held.last_command, held_s);
    }
    held.last_command = command;
    return false;
  }

  template <class Sample>
  bool Expired(const Sample& sample) const {
    return sample.time_s < held.newest_s - limits.duration_s;
  }

  void DropExpired() {
    ForEachChannel(held.samples, [this](auto& samples) {
      while (!samples.empty() && Expired(samples.front())) samples.pop_front();
    });
    DropBeyondMemory();
  }

  void DropBeyondMemory() {
    while (StoredBytes() > limits.memory_bytes) DropOldest();
  }

  void DropOldest() {
    const double oldest_s = StartTime();
    ForEachChannel(held.samples, [oldest_s](auto& samples) {
      if (!samples.empty() && samples.front().time_s <= oldest_s) samples.pop_front();
    });
  }

  std::size_t StoredBytes() const {
    return std::get<0>(held.samples).size() * sizeof(GnssFix) +
           std::get<1>(held.samples).size() * sizeof(HeadingSample) +
           std::get<2>(held.samples).size() * sizeof(ThrusterSample);
  }

  double StartTime() const {
    double oldest_s = std::numeric_limits<double>::infinity();
    ForEachChannel(held.samples, [&oldest_s](const auto& samples) {
      if (!samples.empty()) oldest_s = std::min(oldest_s, samples.front().time_s);
    });
    return oldest_s;
  }

  bool Empty() const {
    return std::get<0>(held.samples).empty() && std::get<1>(held.samples).empty() &&
           std::get<2>(held.samples).empty();
  }

  WindowLimits limits;
  Held held;
  std::optional<Held> former;   ///< of the clock before the last jump, until the new one settles
  double confirmed_s = kNever;  ///< the first time of the present clock
  RejectCounts rejected;
  ClockCheck clock_check;
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
  const auto& [gnss, heading, thrusters] = impl_->held.samples;
  return {{gnss.begin(), gnss.end()},
          {heading.begin(), heading.end()},
          {thrusters.begin(), thrusters.end()},
          impl_->rejected};
}

Recording Window::Snapshot(double duration_s) const {
  const auto& [gnss, heading, thrusters] = impl_->held.samples;
  const double from_s = EndTime() - duration_s;
  return {Since(gnss, from_s), Since(heading, from_s), Since(thrusters, from_s), impl_->rejected};
}

Recording Window::Release() && {
  auto& [gnss, heading, thrusters] = impl_->held.samples;
  return {Drained(gnss), Drained(heading), Drained(thrusters), impl_->rejected};
}

void Window::LimitMemory(std::size_t memory_bytes) {
  Require(memory_bytes >= WindowLimits::kLeastMemory, "a memory limit of kLeastMemory and more");
  impl_->limits.memory_bytes = memory_bytes;
  impl_->DropBeyondMemory();
}

std::size_t Window::StoredBytes() const {
  return impl_->StoredBytes();
}

std::size_t Window::Size(Channel channel) const {
  switch (channel) {
    case Channel::kGnss: return std::get<0>(impl_->held.samples).size();
    case Channel::kHeading: return std::get<1>(impl_->held.samples).size();
    case Channel::kThrusters: return std::get<2>(impl_->held.samples).size();
  }
  return 0;
}

double Window::StartTime() const {
  return Empty() ? 0.0 : impl_->StartTime();
}
double Window::EndTime() const {
  return Empty() ? 0.0 : impl_->held.newest_s;
}
bool Window::Empty() const {
  return impl_->Empty();
}
const RejectCounts& Window::Rejected() const {
  return impl_->rejected;
}

}  // namespace telltale
