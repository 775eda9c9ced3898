#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/loopback_domain.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/client/bus/bus_error.hpp"
#include "telltale/client/bus/bus_log.hpp"
#include "telltale/client/bus/instance_limit.hpp"
#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/watched_reader.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/idl/codec/wire/daemon_status.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/idl/codec/wire/telemetry.hpp"
#include "telltale/idl/codec/wire/vehicle_announcement.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

/// Waits on a wait set until `done`; false when that does not come about in ten seconds.
template <class Done>
bool WaitUntil(WaitSet& wait_set, Done done) {
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (!done()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    wait_set.Wait(100ms);
  }
  return true;
}

class Bus : public testing::Test {
 protected:
  LoopbackDomain domain_;
  Participant here_{domain_.id()};
};

PublishedModel ModelOfRevision(std::uint64_t revision, const std::string& vehicle_id = "boat-1") {
  PublishedModel model{MadeUpIdentification(), revision, 1.0};
  model.identification.vehicle_id = vehicle_id;
  return model;
}

// Anybody can invent vehicle ids, and each costs memory.
TEST_F(Bus, HoldsNoMoreBoatsThanItMay) {
  Reader<telltale_wire_Heading> reader(here_);
  std::size_t received = 0;
  Writer<telltale_wire_Heading> first(here_);
  Writer<telltale_wire_Heading> second(here_);
  ASSERT_TRUE(WaitForMatch(here_, {reader, first, second}, 10s));
  for (int i = 0; i < kMostBoats; ++i) {
    const std::string one = "one-" + std::to_string(i);
    const std::string two = "two-" + std::to_string(i);
    first.Write(Encode(Telemetry<HeadingSample>{one, 1, {}}));
    second.Write(Encode(Telemetry<HeadingSample>{two, 1, {}}));
    received += reader.Take([](const auto&) {});
  }
  received += reader.Take([](const auto&) {});
  EXPECT_EQ(received, static_cast<std::size_t>(kMostBoats));
}

// The same where the contract is reliable, and other topics are received as before.
TEST_F(Bus, HoldsNoMoreKeysOfAReliableTopicThanItsLimit) {
  InstanceLimit limit(3);
  Reader<telltale_wire_IdentifyReply> others(here_);
  Reader<telltale_wire_VehicleAnnouncement> reader(here_, limit);
  const Participant there(domain_.id());
  Writer<telltale_wire_IdentifyReply> other(there);
  Writer<telltale_wire_VehicleAnnouncement> writer(there);
  ASSERT_TRUE(WaitForMatch(here_, {reader, others}, 10s));
  ASSERT_TRUE(WaitForMatch(there, {writer, other}, 10s));
  Vehicle boat = YellowfishVehicle();
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 5; ++i) {
      boat.vehicle_id = "boat-" + std::to_string(i);
      ASSERT_TRUE(writer.Write(Encode(boat)));
    }
  }
  IdentifyReply reply;
  reply.correlation_id = "after";
  reply.vehicle_id = "boat-1";
  reply.outcome = ReplyOutcome::kFailed;
  ASSERT_TRUE(other.Write(Encode(reply)));
  WaitSet wait_set(here_);
  bool has_passed = false;
  wait_set.Attach(others, [&] { has_passed = others.Take([](const auto&) {}) > 0; });
  std::uint64_t refused = 0;
  EXPECT_TRUE(WaitUntil(wait_set, [&] {
    refused += limit.TakeRefused();
    return has_passed && refused >= 2;  // a writer keeps the last sample of each boat alone
  }));
  std::set<std::string> heard;
  reader.Take([&](const auto& wire) { heard.insert(Decode(wire)->vehicle_id); });
  EXPECT_THAT(heard, testing::ElementsAre("boat-0", "boat-1", "boat-2"));
}

TEST_F(Bus, HandsOverEverySampleOfABurstInOrder) {
  Reader<telltale_wire_GnssFix> reader(here_);
  Writer<telltale_wire_GnssFix> writer(here_);
  ASSERT_TRUE(WaitForMatch(here_, {reader, writer}, 10s));
  for (std::uint64_t i = 1; i <= 64; ++i) {
    writer.Write(Encode(Telemetry<GnssFix>{"boat-1", i, {}}));
  }
  std::vector<std::uint64_t> received;
  WaitSet wait_set(here_);
  wait_set.Attach(reader, [&] {
    reader.Take([&](const auto& wire) { received.push_back(wire.sequence_number); });
  });
  ASSERT_TRUE(WaitUntil(wait_set, [&] { return received.size() >= 64; }));
  for (std::size_t i = 0; i < received.size(); ++i) EXPECT_EQ(received[i], i + 1);
}

TEST_F(Bus, TakesMoreThanOneBatch) {
  Reader<telltale_wire_GnssFix> reader(here_);
  Writer<telltale_wire_GnssFix> writer(here_);
  ASSERT_TRUE(WaitForMatch(here_, {reader, writer}, 10s));
  std::map<std::string, std::uint64_t> received;
  for (std::uint64_t i = 1; i <= 60; ++i) {
    for (int boat = 0; boat < 10; ++boat) {
      writer.Write(Encode(Telemetry<GnssFix>{"boat-" + std::to_string(boat), i, {}}));
    }
  }
  WaitSet wait_set(here_);
  std::size_t total = 0;
  wait_set.Attach(reader,
                  [&] { total += reader.Take([&](const auto& w) { ++received[w.vehicle_id]; }); });
  ASSERT_TRUE(WaitUntil(wait_set, [&] { return total >= 600; }));
  EXPECT_EQ(received.size(), 10u);
  for (const auto& [boat, count] : received) EXPECT_EQ(count, 60u) << boat;
}

TEST_F(Bus, SkipsTheNoticeThatAWriterIsGone) {
  Reader<telltale_wire_Model> reader(here_);
  std::optional<Writer<telltale_wire_Model>> writer(here_);
  ASSERT_TRUE(WaitForMatch(here_, {reader, *writer}, 10s));
  writer->Write(Encode(ModelOfRevision(1)));
  WaitSet wait_set(here_);
  int notices = 0;
  int models = 0;
  wait_set.Attach(reader, [&] {
    ++notices;
    models += static_cast<int>(reader.Take([](const auto&) {}));
  });
  ASSERT_TRUE(WaitUntil(wait_set, [&] { return models == 1; }));
  const int before = notices;
  writer.reset();
  ASSERT_TRUE(WaitUntil(wait_set, [&] { return notices > before; }));
  EXPECT_EQ(models, 1);
}

/// Which daemons a reader of their statuses has heard of, and which are gone since.
struct HeardDaemons {
  explicit HeardDaemons(const Participant& participant)
      : reader(participant), wait_set(participant) {
    wait_set.Attach(reader, [this] {
      reader.Take([this](const auto& wire) { alive.insert(wire.daemon_id); },
                  [this](const auto& gone) { alive.erase(gone.daemon_id); });
    });
  }

  Reader<telltale_wire_DaemonStatus> reader;
  WaitSet wait_set;
  std::set<std::string> alive;
};

TEST_F(Bus, TellsWhoseWriterIsGone) {
  HeardDaemons heard(here_);
  Writer<telltale_wire_DaemonStatus> one(here_);
  std::optional<Writer<telltale_wire_DaemonStatus>> two(here_);
  one.Write(Encode(DaemonStatus{"one", true, 1, 1}));
  two->Write(Encode(DaemonStatus{"two", false, 1, 2}));
  ASSERT_TRUE(WaitUntil(heard.wait_set, [&] { return heard.alive.size() == 2; }));
  two.reset();
  ASSERT_TRUE(WaitUntil(heard.wait_set, [&] { return heard.alive.size() == 1; }));
  EXPECT_TRUE(heard.alive.contains("one"));
}

/// Which boats a reader of announcements has heard of, and which are disposed of since.
struct HeardBoats {
  explicit HeardBoats(const Participant& participant) : reader(participant), wait_set(participant) {
    wait_set.Attach(reader, [this] { Take(); });
  }

  void Take() {
    reader.TakeOrDispose([this](const auto& wire) { announced.insert(wire.vehicle_id); },
                         [this](const auto& wire, WriterHandle writer) {
                           announced.erase(wire.vehicle_id);
                           disposed[wire.vehicle_id] = writer;
                         });
  }

  Reader<telltale_wire_VehicleAnnouncement> reader;
  WaitSet wait_set;
  std::set<std::string> announced;
  std::map<std::string, WriterHandle> disposed;
};

TEST_F(Bus, TellsDisposalFromLeaving) {
  HeardBoats heard(here_);
  std::optional<Writer<telltale_wire_VehicleAnnouncement>> leaving(here_);
  Writer<telltale_wire_VehicleAnnouncement> writer(here_);
  leaving->Write(EncodeRetired("leaves"));
  leaving->Write(EncodeRetired("by-another"));
  writer.Write(EncodeRetired("disposed"));
  ASSERT_TRUE(WaitUntil(heard.wait_set, [&] { return heard.announced.size() == 3; }));
  leaving.reset();
  writer.Dispose(EncodeRetired("disposed"));
  writer.Dispose(EncodeRetired("by-another"));  // whose writer is gone
  ASSERT_TRUE(WaitUntil(heard.wait_set, [&] { return heard.disposed.size() == 2; }));
  EXPECT_THAT(heard.announced, testing::ElementsAre("leaves"));
  EXPECT_THAT(heard.reader.Writers(), testing::Contains(heard.disposed["by-another"]));
}

// The reader keeps one sample of a boat, which may hold data as well.
TEST_F(Bus, TellsDisposalOfWhatItHasNotTakenYet) {
  HeardBoats heard(here_);
  Writer<telltale_wire_VehicleAnnouncement> writer(here_);
  ASSERT_TRUE(WaitForMatch(here_, {heard.reader, writer}, 10s));
  writer.Write(EncodeRetired("gone"));
  writer.Dispose(EncodeRetired("gone"));
  writer.Write(EncodeRetired("back"));
  writer.Dispose(EncodeRetired("back"));
  writer.Write(EncodeRetired("back"));
  ASSERT_TRUE(writer.AwaitReceipt(10s));
  heard.Take();
  EXPECT_THAT(heard.announced, testing::ElementsAre("back"));
  EXPECT_TRUE(heard.disposed.contains("gone"));
}

TEST_F(Bus, BelievesTheStrongestWriterThatIsAlive) {
  Reader<telltale_wire_Model> reader(here_);
  Writer<telltale_wire_Model> weak(here_, WithOwnershipStrength(ModelQos(), 1));
  std::optional<Writer<telltale_wire_Model>> strong;
  strong.emplace(here_, WithOwnershipStrength(ModelQos(), 2));
  std::vector<std::uint64_t> received;
  WaitSet wait_set(here_);
  wait_set.Attach(reader,
                  [&] { reader.Take([&](const auto& w) { received.push_back(w.revision); }); });
  weak.Write(Encode(ModelOfRevision(1)));
  ASSERT_TRUE(WaitUntil(wait_set, [&] { return received.size() == 1; }));
  strong->Write(Encode(ModelOfRevision(2)));
  weak.Write(Encode(ModelOfRevision(3)));
  strong->Write(Encode(ModelOfRevision(4)));
  ASSERT_TRUE(WaitUntil(wait_set, [&] { return received.back() == 4; }));
  EXPECT_THAT(received, testing::Not(testing::Contains(3)));
}

TEST_F(Bus, ReadsFromOthersAlone) {
  const Reader<telltale_wire_Model> from_others(here_, FromOthers(ModelQos()));
  const Writer<telltale_wire_Model> own(here_);
  const Participant there(domain_.id());
  const Writer<telltale_wire_Model> of_another(there);
  ASSERT_TRUE(WaitForMatch(here_, {from_others}, 10s));
  EXPECT_EQ(from_others.Matched(), 1u);
}

TEST_F(Bus, GivesALateReaderTheLastModelOfEachVehicle) {
  Writer<telltale_wire_Model> writer(here_);
  for (std::uint64_t revision = 1; revision <= 3; ++revision) {
    writer.Write(Encode(ModelOfRevision(revision, "boat-1")));
    writer.Write(Encode(ModelOfRevision(10 * revision, "boat-2")));
  }
  Reader<telltale_wire_Model> reader(here_);
  std::map<std::string, std::vector<std::uint64_t>> received;
  WaitSet wait_set(here_);
  wait_set.Attach(reader, [&] {
    reader.Take([&](const auto& wire) { received[wire.vehicle_id].push_back(wire.revision); });
  });
  ASSERT_TRUE(WaitUntil(wait_set, [&] { return received.size() == 2; }));
  EXPECT_THAT(received["boat-1"], testing::ElementsAre(3));
  EXPECT_THAT(received["boat-2"], testing::ElementsAre(30));
}

TEST_F(Bus, SaysWhenNobodyIsThere) {
  Writer<telltale_wire_GnssFix> writer(here_);
  EXPECT_FALSE(WaitForMatch(here_, {writer}, 50ms));
  EXPECT_EQ(writer.Matched(), 0u);
}

TEST_F(Bus, ABestEffortReaderMatchesAReliableWriter) {
  Reader<telltale_wire_GnssFix> reader(here_);
  Qos reliable(dds_create_qos());
  dds_qset_reliability(reliable.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  const Entity topic(dds_create_topic(here_.handle(), &Descriptor<telltale_wire_GnssFix>(),
                                      kContract<telltale_wire_GnssFix>.topic, nullptr, nullptr));
  const Entity writer(dds_create_writer(here_.handle(), topic.handle(), reliable.get(), nullptr));
  EXPECT_TRUE(WaitForMatch(here_, {reader}, 10s));
}

TEST_F(Bus, WaitsNoTimeForADeadlineThatHasPassed) {
  WaitSet wait_set(here_);
  EXPECT_FALSE(wait_set.Wait(-1ms));
}

TEST_F(Bus, WakesAWaitingThread) {
  WaitSet wait_set(here_);
  std::jthread waker([&] { wait_set.Wake(); });
  EXPECT_FALSE(wait_set.Wait(10min));
}

TEST_F(Bus, ReopensASilentReaderAndReceivesAgain) {
  WaitSet wait_set(here_);
  int heard = 0;
  WatchedReader<telltale_wire_GnssFix> reader(
      here_, wait_set, [&](const auto&) { ++heard; }, 60s);
  const auto now = std::chrono::steady_clock::now();
  EXPECT_FALSE(reader.ReopenIfSilent(now + 10min)) << "nobody is connected, so silence is right";
  Writer<telltale_wire_GnssFix> writer(here_);
  ASSERT_TRUE(WaitForMatch(here_, {writer}, 10s));
  EXPECT_FALSE(reader.ReopenIfSilent(now + 10min + 59s));
  EXPECT_TRUE(reader.ReopenIfSilent(now + 20min));
  ASSERT_TRUE(WaitForMatch(here_, {writer}, 10s));
  writer.Write(Encode(Telemetry<GnssFix>{"boat-1", 1, {}}));
  EXPECT_TRUE(WaitUntil(wait_set, [&] { return heard == 1; }));
}

TEST(BusError, SaysWhatWasTriedAndWhyItFailed) {
  try {
    Checked(DDS_RETCODE_BAD_PARAMETER, "creating a reader");
    FAIL();
  } catch (const BusError& error) {
    EXPECT_EQ(error.code(), DDS_RETCODE_BAD_PARAMETER);
    EXPECT_EQ(std::string(error.what()),
              std::string("creating a reader: ") + dds_strretcode(DDS_RETCODE_BAD_PARAMETER));
  }
}

TEST(RateLimit, HoldsBackAndSaysHowMany) {
  RateLimit limit(2, 10s);
  const RateLimit::TimePoint start{};
  EXPECT_EQ(limit.Admit(start), 0u);
  EXPECT_EQ(limit.Admit(start + 1s), 0u);
  EXPECT_FALSE(limit.Admit(start + 2s));
  EXPECT_FALSE(limit.Admit(start + 9s));
  EXPECT_EQ(limit.Admit(start + 10s), 2u);
  EXPECT_EQ(limit.Admit(start + 11s), 0u);
}

}  // namespace
}  // namespace telltale
