#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "telltale/client/bus/endpoint.hpp"

namespace telltale {

/// Receives the samples of any topic, of a type known by its name alone, as the bytes that came.
/// Use from one thread at a time, and never inside a DDS listener.
class SerializedReader : public Endpoint {
 public:
  using Receive = std::function<void(std::span<const std::uint8_t>)>;

  /// Throws BusError.
  SerializedReader(const Participant& participant, const std::string& topic,
                   const std::string& type, const dds_qos_t* qos);

  /// Hands the bytes of all samples that have arrived to `receive`, encapsulation included.
  void Take(const Receive& receive);
};

}  // namespace telltale
