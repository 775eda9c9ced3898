#pragma once

#include <functional>
#include <string>

#include "telltale/client/bus/endpoint.hpp"

namespace telltale {

/// Somebody publishes a topic.
struct Publication {
  std::string topic;
  std::string type;
};

/// Tells of every writer in the domain, those of this process included, as it is discovered.
class PublicationReader : public Endpoint {
 public:
  /// Throws BusError.
  explicit PublicationReader(const Participant& participant);

  /// Hands on what has been discovered since the last time.
  void Take(const std::function<void(const Publication&)>& discovered);
};

}  // namespace telltale
