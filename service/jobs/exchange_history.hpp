#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace telltale {

/// What became of each request, by its correlation id: its progress while it is queued or running,
/// its reply afterwards. A request whose id is here is not worked on again. Only the latest replies
/// are kept. Not thread safe.
template <class Stage, class Reply>
class ExchangeHistory {
 public:
  using Answer = std::variant<Stage, Reply>;

  /// Replies are some ten kilobytes each, and a client that misses one asks again within seconds.
  static constexpr std::size_t kKeptReplies = 256;

  /// What to answer to a request with this id; nothing where the id is new.
  std::optional<Answer> Find(const std::string& correlation_id) const {
    if (const auto reply = replies_.find(correlation_id); reply != replies_.end()) {
      return reply->second;
    }
    if (const auto stage = unfinished_.find(correlation_id); stage != unfinished_.end()) {
      return stage->second;
    }
    return std::nullopt;
  }

  void Begin(const Stage& stage) { unfinished_.emplace(stage.correlation_id, stage); }

  /// Notes the progress of an unfinished request. Returns it where clients should hear of it: in
  /// another stage, or further by a fiftieth of the work.
  std::optional<Stage> Advance(const std::string& correlation_id, std::string_view stage,
                               double fraction) {
    constexpr double kReportedStep = 0.02;
    Stage& last = unfinished_.find(correlation_id)->second;
    if (last.stage == stage && fraction - last.fraction < kReportedStep) return std::nullopt;
    last.stage = stage;
    last.fraction = std::clamp(fraction, 0.0, 1.0);
    return last;
  }

  /// Takes the id of an unfinished request for a new one from now on.
  void Forget(const std::string& correlation_id) { unfinished_.erase(correlation_id); }

  void Finish(const Reply& reply) {
    unfinished_.erase(reply.correlation_id);
    replies_.insert_or_assign(reply.correlation_id, reply);
    finished_.push_back(reply.correlation_id);
    if (finished_.size() <= kKeptReplies) return;
    replies_.erase(finished_.front());
    finished_.pop_front();
  }

 private:
  std::map<std::string, Stage> unfinished_;
  std::map<std::string, Reply> replies_;
  std::deque<std::string> finished_;  ///< correlation ids of replies_, oldest first
};

}  // namespace telltale
