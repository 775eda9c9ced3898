#include <chrono>
#include <optional>

#include <gtest/gtest.h>

#include "client/bus/first_quality.h"
#include "support/loopback_domain.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/quality.hpp"

namespace telltale {

/// On the bus the type has the name that it had in every version.
template <>
const dds_topic_descriptor_t& Descriptor<telltale_first_Quality>() {
  static const dds_topic_descriptor_t kDescriptor = [] {
    dds_topic_descriptor_t descriptor = telltale_first_Quality_desc;
    descriptor.m_typename = telltale_wire_Quality_desc.m_typename;
    return descriptor;
  }();
  return kDescriptor;
}

template <>
inline constexpr Contract kContract<telltale_first_Quality> = kContract<telltale_wire_Quality>;

namespace {

using namespace std::chrono_literals;

class MixedVersions : public testing::Test {
 protected:
  /// Writes the sample until the reader, of another version, has one; what `read` makes of it.
  template <class From, class To, class Read>
  auto Sent(const WireSample<From>& sample, Read read) {
    Writer<From> writer(here_);
    Reader<To> reader(there_);
    std::optional<decltype(read(std::declval<const To&>()))> received;
    WaitSet wait_set(there_);
    wait_set.Attach(reader, [&] { reader.Take([&](const To& wire) { received = read(wire); }); });
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    while (!received && std::chrono::steady_clock::now() < deadline) {
      writer.Write(sample);
      wait_set.Wait(100ms);
    }
    return received;
  }

  LoopbackDomain domain_;
  Participant here_{domain_.id()};
  Participant there_{domain_.id()};
};

TEST_F(MixedVersions, AMonitorOfAVersionBeforeReadsTheFieldsThatItKnows) {
  Quality quality;
  quality.vehicle_id = "boat-1";
  quality.sequence_number = 7;
  quality.window_s = 600.0;
  quality.drift_evidence = "port thruster 14 % weaker";
  const auto window_s = Sent<telltale_wire_Quality, telltale_first_Quality>(
      Encode(quality), [](const auto& wire) { return wire.window_s; });
  EXPECT_EQ(window_s, 600.0);
}

TEST_F(MixedVersions, ADaemonOfAVersionBeforeLeavesEmptyWhatItDoesNotKnow) {
  WireSample<telltale_first_Quality> sample;
  wire::Put(sample->vehicle_id, "boat-1");
  sample->sequence_number = 7;
  sample->window_s = 600.0;
  const auto quality = Sent<telltale_first_Quality, telltale_wire_Quality>(
      sample, [](const auto& wire) { return Decode(wire); });
  ASSERT_TRUE(quality);
  ASSERT_TRUE(*quality) << quality->error().Message();
  EXPECT_EQ((*quality)->window_s, 600.0);
  EXPECT_EQ((*quality)->verdict, QualityVerdict::kUnknown);
  EXPECT_EQ((*quality)->drift_evidence, "");
}

}  // namespace
}  // namespace telltale
