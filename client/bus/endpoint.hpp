#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "telltale/client/bus/entity.hpp"
#include "telltale/client/bus/participant.hpp"

namespace telltale {

/// Names a writer in the samples that a reader takes.
using WriterHandle = dds_instance_handle_t;

/// Names the key of a sample, such as the vehicle it is of. No other key ever gets the same.
using InstanceHandle = dds_instance_handle_t;

/// One end of a topic, reader or writer. Throws BusError when it cannot be made.
class Endpoint {
 public:
  dds_entity_t handle() const { return end_.handle(); }

  /// How many ends of the other kind it is connected to.
  std::uint32_t Matched() const;

  /// The partitions of a writer that this reader is connected to; none where it is gone, or has
  /// named none.
  std::vector<std::string> PartitionsOf(WriterHandle writer) const;

  /// The writers that this reader is connected to.
  std::set<WriterHandle> Writers() const;

  /// The status that changes when a connection comes or goes.
  std::uint32_t match_status() const {
    return kind_ == Kind::kReader ? DDS_SUBSCRIPTION_MATCHED_STATUS
                                  : DDS_PUBLICATION_MATCHED_STATUS;
  }

 protected:
  enum class Kind { kReader, kWriter };

  Endpoint(const Participant& participant, Kind kind, const dds_topic_descriptor_t& type,
           const char* topic, const dds_qos_t* qos);
  /// `name`: what errors call the topic.
  Endpoint(const Participant& participant, Kind kind, Entity topic, const std::string& name,
           const dds_qos_t* qos);
  /// Throws BusError.
  static Entity MakeTopic(const Participant& participant, const dds_topic_descriptor_t& type,
                          const char* topic);
  Endpoint(Endpoint&&) noexcept = default;
  Endpoint& operator=(Endpoint&&) noexcept = default;
  ~Endpoint() = default;

 private:
  Kind kind_;
  Entity topic_;
  Entity end_;  // after the topic it refers to, so that it goes first
};

/// Waits until every endpoint is connected to another; false when that takes longer than `timeout`.
/// What is written before both ends know of each other is lost.
bool WaitForMatch(const Participant& participant,
                  const std::vector<std::reference_wrapper<const Endpoint>>& endpoints,
                  std::chrono::nanoseconds timeout);

}  // namespace telltale
