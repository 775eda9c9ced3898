#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "telltale/idl/codec/stored_request.hpp"

namespace telltale {

/// A request without an answer.
struct HeardRequest {
  AnyRequest request;
  bool begun = false;  ///< the daemon that served was at work on it
};

/// The requests that a standby has heard and nobody has answered: it works on them when it takes
/// over. Of requests and of answers the latest 1024 are known. Thread safe.
class HeardRequests {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMost = 1024;

  /// False once they have been taken: the request is this daemon's own to work on.
  bool Note(const AnyRequest& request, Clock::time_point now);

  /// The request has its reply, or will not get one.
  void Answered(const std::string& correlation_id);

  /// The daemon that serves is at work on the request.
  void Begun(const std::string& correlation_id);

  /// Those without an answer, oldest first, each with what is left of its deadline. Those whose
  /// deadline has passed are not among them. From now on none is noted.
  std::vector<HeardRequest> TakeUnanswered(Clock::time_point now);

 private:
  struct Heard {
    AnyRequest request;
    Clock::time_point since;
    bool begun = false;
  };

  std::mutex mutex_;  // of what follows
  bool taken_ = false;
  std::map<std::string, Heard> unanswered_;  ///< by correlation id
  std::deque<std::string> order_;            ///< of their ids, and of some that are answered
  std::set<std::string> answered_;
  std::deque<std::string> answered_order_;
};

}  // namespace telltale
