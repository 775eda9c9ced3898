#include "telltale/idl/codec/wire/daemon_status.hpp"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(WireDaemonStatus, ArrivesAsItWasSent) {
  const auto status = Decode(Encode(DaemonStatus{"d-1", true, 7, 20}));
  ASSERT_TRUE(status);
  EXPECT_EQ(status->daemon_id, "d-1");
  EXPECT_TRUE(status->serves);
  EXPECT_EQ(status->term, 7u);
  EXPECT_EQ(status->ownership_strength, 20u);
}

TEST(WireDaemonStatus, RefusesWhatNoDaemonSays) {
  const auto field_at_fault = [](auto change) {
    auto wire = Encode(DaemonStatus{"d-1", true, 7, 20});
    change(wire);
    const auto status = Decode(wire);
    return status ? std::string() : status.error().field;
  };
  EXPECT_EQ(field_at_fault([](auto& wire) { std::strcpy(wire.daemon_id, "two words"); }),
            "daemon_id");
  EXPECT_EQ(field_at_fault([](auto& wire) { wire.term = 0; }), "term") << "it serves";
  EXPECT_EQ(field_at_fault([](auto& wire) { wire.term = kHighestTerm + 1; }), "term");
  EXPECT_EQ(field_at_fault([](auto& wire) { wire.ownership_strength = 0; }), "ownership_strength");
  EXPECT_EQ(field_at_fault([](auto& wire) { wire.ownership_strength = 1001; }),
            "ownership_strength");
}

}  // namespace
}  // namespace telltale
