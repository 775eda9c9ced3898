#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "codec/daemon_config.hpp"
#include "codec/messages.hpp"
#include "identification/answers.hpp"
#include "identification/identify.hpp"
#include "ingest/fleet.hpp"
#include "models/published_models.hpp"

namespace telltale {

/// The request's wishes, and the daemon's settings and defaults for the rest.
IdentifyOptions OptionsOf(const IdentifyRequest& request, const IdentificationSettings& settings);

/// Identifies on request, on worker threads. A bounded queue; one identification at a time for each
/// vehicle; every correlation id is worked on once: asked again it is told how far the work is, or
/// given its reply again. Whatever goes wrong in one identification ends in its reply.
class IdentificationJobs {
 public:
  IdentificationJobs(Fleet& fleet, PublishedModels& models, Answers& answers,
                     const IdentificationSettings& settings);
  IdentificationJobs(const IdentificationJobs&) = delete;
  IdentificationJobs& operator=(const IdentificationJobs&) = delete;
  ~IdentificationJobs();  ///< breaks off what is running and ends the workers

  /// Takes a request in and returns; the answer goes out through Answers.
  void Submit(IdentifyRequest request);

 private:
  using Queue = std::deque<IdentifyRequest>;

  void Work();
  Queue::iterator NextRunnable();
  IdentifyReply Answer(const IdentifyRequest& request);
  IdentifyReply IdentifyAndPublish(const IdentifyRequest& request);
  void Report(const IdentifyRequest& request, std::string_view stage, double fraction);
  void Remember(const IdentifyReply& reply);

  Fleet& fleet_;
  PublishedModels& models_;
  Answers& answers_;
  const IdentificationSettings settings_;

  std::mutex mutex_;
  std::condition_variable changed_;
  Queue queue_;
  std::map<std::string, IdentifyProgress> unfinished_;  ///< by correlation id, queued or running
  std::set<std::string> running_vehicles_;
  std::map<std::string, IdentifyReply> finished_;  ///< by correlation id, the latest few
  std::deque<std::string> finished_order_;
  std::atomic<bool> stopping_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace telltale
