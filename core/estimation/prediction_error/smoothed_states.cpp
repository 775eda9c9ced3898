#include "telltale/core/estimation/prediction_error/smoothed_states.hpp"

#include <deque>
#include <limits>
#include <utility>

namespace telltale {
namespace {

/// Holds the moves of the filter since the start of the oldest window that is open, and none while
/// none is.
class FixedLagSmoother {
 public:
  explicit FixedLagSmoother(const std::vector<SmoothingWindow>& windows) : windows_(windows) {}

  void Add(const FilterMove& move) {
    if (!open_.empty()) moves_.push_back(move);
  }

  bool HasOneToOpen(double before_s) const {
    return opened_ < windows_.size() && windows_[opened_].time_s < before_s;
  }
  double NextOpening() const { return windows_[opened_].time_s; }
  void Open(const ExtendedKalmanFilter& filter) {
    open_.push_back({filter.Mean(), filter.Covariance(), dropped_ + moves_.size()});
    ++opened_;
  }

  void CloseBefore(double time_s) {
    while (!open_.empty() && windows_[states_.size()].until_s < time_s) CloseOldest();
  }
  void CloseAll() {
    while (!open_.empty()) CloseOldest();
  }

  std::vector<FilterState> TakeStates() { return std::move(states_); }

 private:
  struct Start {
    FilterState mean;
    FilterCovariance covariance;
    std::size_t moves_before;
  };

  void CloseOldest() {
    const Start& start = open_.front();
    states_.emplace_back(start.mean + start.covariance * ScoreOfMovesSince(start));
    open_.pop_front();
    const std::size_t needed =
        open_.empty() ? dropped_ + moves_.size() : open_.front().moves_before;
    for (; dropped_ < needed; ++dropped_) moves_.pop_front();
  }

  // The slope of the log-likelihood of later readings by the state, from the last one back.
  FilterState ScoreOfMovesSince(const Start& start) const {
    FilterState score = FilterState::Zero();
    for (std::size_t k = moves_.size(); k > start.moves_before - dropped_; --k) {
      const FilterMove& move = moves_[k - 1];
      if (move.transition) {
        score = (move.transition->transpose() * score).eval();
      } else {
        score += move.row.transpose() * (move.weighted_innovation - move.gain.dot(score));
      }
    }
    return score;
  }

  const std::vector<SmoothingWindow>& windows_;
  std::size_t opened_ = 0;
  std::deque<FilterMove> moves_;
  std::size_t dropped_ = 0;
  std::deque<Start> open_;
  std::vector<FilterState> states_;
};

}  // namespace

std::vector<FilterState> SmoothedStates(const RawSignals& signals, const HeldCommands& commands,
                                        const FilterSettings& settings,
                                        const std::vector<SmoothingWindow>& windows) {
  const auto readings = ReadingsOf(signals, settings.nominal_fix_delay_s);
  const auto start = StartOf(readings);
  if (!start) return {};
  ExtendedKalmanFilter filter(settings, commands, readings.front().time_s, *start);
  FixedLagSmoother smoother(windows);
  filter.VisitMoves([&smoother](const FilterMove& move) { smoother.Add(move); });
  const auto open_before = [&](double time_s) {
    while (smoother.HasOneToOpen(time_s)) {
      filter.PredictTo(smoother.NextOpening());
      smoother.Open(filter);
    }
  };
  std::vector<Innovation> innovations;
  for (const Reading& reading : readings) {
    open_before(reading.time_s);
    smoother.CloseBefore(reading.time_s);
    filter.Take(reading, innovations);
  }
  open_before(std::numeric_limits<double>::infinity());
  smoother.CloseAll();
  return smoother.TakeStates();
}

std::vector<FilterState> PredictedStates(const FilterState& start, double start_s,
                                         const HeldCommands& commands,
                                         const FilterSettings& settings,
                                         const std::vector<double>& times_s) {
  ExtendedKalmanFilter filter(settings, commands, start_s, start);
  const std::vector<FilterGain> none;
  filter.UseGains(&none, nullptr);  // no reading asks for a covariance
  std::vector<FilterState> states;
  for (const double time_s : times_s) {
    filter.PredictTo(time_s);
    states.push_back(filter.Mean());
  }
  return states;
}

}  // namespace telltale
