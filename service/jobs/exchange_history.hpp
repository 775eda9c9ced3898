#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "telltale/service/jobs/reply_size.hpp"

namespace telltale {

/// What became of each request, by its correlation id: its progress while it is queued or running,
/// its reply afterwards. A request whose id is here is not worked on again. The latest replies are
/// kept, within bounds of their number and of their bytes; the newest is kept whatever its size.
/// Not thread safe.
template <class Stage, class Reply>
class ExchangeHistory {
 public:
  using Answer = std::variant<Stage, Reply>;

  /// A client that misses a reply asks again within seconds.
  static constexpr std::size_t kKeptReplies = 256;
  static constexpr std::size_t kKeptBytes = 8 << 20;  ///< by SizeOf() of the replies

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
    DropReply(reply.correlation_id);
    const std::size_t bytes = SizeOf(reply);
    finished_.push_back({reply.correlation_id, bytes});
    kept_bytes_ += bytes;
    replies_.emplace(reply.correlation_id, reply);
    while (finished_.size() > kKeptReplies || (kept_bytes_ > kKeptBytes && finished_.size() > 1)) {
      DropReply(std::string(finished_.front().correlation_id));
    }
  }

 private:
  struct Finished {
    std::string correlation_id;
    std::size_t bytes = 0;
  };

  void DropReply(const std::string& correlation_id) {
    if (replies_.erase(correlation_id) == 0) return;
    const auto dropped = std::ranges::find(finished_, correlation_id, &Finished::correlation_id);
    kept_bytes_ -= dropped->bytes;
    finished_.erase(dropped);
  }

  std::map<std::string, Stage> unfinished_;
  std::map<std::string, Reply> replies_;
  std::deque<Finished> finished_;  ///< of replies_, oldest first
  std::size_t kept_bytes_ = 0;     ///< of replies_
};

}  // namespace telltale
