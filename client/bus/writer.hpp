#pragma once

#include <chrono>

#include "telltale/client/bus/bus_error.hpp"
#include "telltale/client/bus/endpoint.hpp"
#include "telltale/client/bus/topics.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// Publishes samples of one wire type under its topic's contract. Safe to use from several threads.
template <class Wire>
class Writer : public Endpoint {
 public:
  /// `qos`: the contract of the topic, or one that is made from it.
  explicit Writer(const Participant& participant, const Qos& qos = kContract<Wire>.qos())
      : Endpoint(participant, Kind::kWriter, Descriptor<Wire>(), kContract<Wire>.topic, qos.get()) {
  }

  /// False when a stalled reader left no room within the contract's longest block.
  bool Write(const Wire& sample) {
    const dds_return_t result = dds_write(handle(), &sample);
    if (result == DDS_RETCODE_TIMEOUT) return false;
    Checked(result, std::string("writing to ") + kContract<Wire>.topic);
    return true;
  }
  bool Write(const WireSample<Wire>& sample) { return Write(*sample); }

  /// Disposes of the sample's key, also with readers that do not know it.
  void Dispose(const WireSample<Wire>& sample) {
    Checked(dds_writedispose(handle(), &*sample),
            std::string("disposing on ") + kContract<Wire>.topic);
  }

  /// Gives up the ownership of the sample's key; what was written of it stays with its readers.
  void Unregister(const Wire& sample) {
    Checked(dds_unregister_instance(handle(), &sample),
            std::string("unregistering on ") + kContract<Wire>.topic);
  }
  void Unregister(const WireSample<Wire>& sample) { Unregister(*sample); }

  /// Sends what batched writes have gathered.
  void Flush() { dds_write_flush(handle()); }

  /// Waits until every reliable reader has all that was written; false where that takes longer.
  bool AwaitReceipt(std::chrono::nanoseconds timeout) {
    return dds_wait_for_acks(handle(), timeout.count()) == DDS_RETCODE_OK;
  }

  /// Says that the loop this is called from is still at work.
  void AssertLiveliness() {
    Checked(dds_assert_liveliness(handle()),
            std::string("asserting liveliness on ") + kContract<Wire>.topic);
  }
};

/// Gathers the small samples of every writer in this process into large packets, each sent when
/// full or on Flush. Takes effect for writers made afterwards.
inline void BatchWrites() {
  dds_write_set_batch(true);
}

}  // namespace telltale
