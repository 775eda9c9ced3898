#include "telltale/service/workers/taken_jobs.hpp"

#include <optional>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/workers/heavy_jobs.hpp"
#include "telltale/service/workers/offered_jobs.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr WorkerSettings kLong{.lease_s = 600.0};  // longer than any test
constexpr WorkerSettings kShort{.lease_s = 0.05};  // the configuration allows 1 s and more

class TakenJobsTest : public ::testing::Test {
 protected:
  /// Once a lease has run out.
  static TakenJob AwaitJob(TakenJobs& jobs) {
    for (;;) {
      if (auto job = jobs.Take()) return *std::move(job);
    }
  }

  EngineStorage engine_{Engine::kPostgres};
  OfferedJobs offered_{engine_.Storage(), kLong.lease_s};
};

TEST_F(TakenJobsTest, GiveEachJobToOneWorkerOldestFirst) {
  TakenJobs one(engine_.Storage(), "one", kLong);
  TakenJobs two(engine_.Storage(), "two", kLong);
  EXPECT_EQ(offered_.Workers(), 2);
  EXPECT_FALSE(one.Take());
  const auto first = offered_.Offer("a", "boat-1", std::string("\0task", 5));
  const auto second = offered_.Offer("b", "boat-2", "another");
  const auto of_one = one.Take();
  const auto of_two = two.Take();
  ASSERT_TRUE(of_one && of_two);
  EXPECT_EQ(of_one->number, first);
  EXPECT_EQ(of_one->attempt, 1);
  EXPECT_EQ(of_one->correlation_id, "a");
  EXPECT_EQ(of_one->vehicle_id, "boat-1");
  EXPECT_EQ(of_one->task, std::string("\0task", 5));
  EXPECT_EQ(of_two->number, second);
  EXPECT_FALSE(one.Take());

  ASSERT_TRUE(one.Prolong(*of_one, "half way", 0.5));
  const auto state = offered_.Ask(first);
  ASSERT_TRUE(state);
  EXPECT_TRUE(state->taken);
  EXPECT_EQ(state->worker, "one");
  EXPECT_EQ(state->stage, "half way");
  EXPECT_EQ(state->fraction, 0.5);
  EXPECT_FALSE(state->outcome);
  ASSERT_TRUE(one.Answer(*of_one, std::string("out\0come", 8)));
  EXPECT_EQ(offered_.Ask(first)->outcome, std::string("out\0come", 8));
}

TEST_F(TakenJobsTest, AreTakenFromAWorkerThatIsSilentWhoseWordCountsNoMore) {
  TakenJobs silent(engine_.Storage(), "silent", kShort);
  TakenJobs next(engine_.Storage(), "next", kLong);
  const auto number = offered_.Offer("a", "boat-1", "task");
  const TakenJob first = AwaitJob(silent);
  const TakenJob second = AwaitJob(next);
  EXPECT_EQ(second.number, number);
  EXPECT_EQ(second.attempt, 2);
  EXPECT_FALSE(silent.Prolong(first, "late", 0.1));
  EXPECT_FALSE(silent.Answer(first, "late"));
  EXPECT_FALSE(silent.GiveBack(first));
  EXPECT_TRUE(next.Answer(second, "in time"));
  EXPECT_EQ(offered_.Ask(number)->outcome, "in time");
}

TEST_F(TakenJobsTest, AreLeftToOthersWhereTheyAreGivenBack) {
  TakenJobs one(engine_.Storage(), "one", kLong);
  TakenJobs two(engine_.Storage(), "two", kLong);
  offered_.Offer("a", "boat-1", "task");
  ASSERT_TRUE(one.GiveBack(one.Take().value()));
  EXPECT_EQ(two.Take().value().attempt, 1);
}

TEST_F(TakenJobsTest, EndWhereTheDaemonWithdrawsOrAsksForSomethingElse) {
  TakenJobs worker(engine_.Storage(), "worker", kLong);
  const auto number = offered_.Offer("a", "boat-1", "task");
  const auto withdrawn = worker.Take();
  offered_.Withdraw(number);
  EXPECT_FALSE(offered_.Ask(number));
  EXPECT_FALSE(worker.Prolong(*withdrawn, "", 0.0));

  offered_.Offer("b", "boat-1", "task");
  const auto replaced = worker.Take();
  offered_.Offer("b", "boat-1", "anew");
  EXPECT_FALSE(worker.Answer(*replaced, "of before"));
  EXPECT_EQ(worker.Take().value().task, "anew");
}

TEST_F(TakenJobsTest, AreDroppedWhereTheirDaemonIsGone) {
  TakenJobs worker(engine_.Storage(), "worker", kLong);
  OfferedJobs dead(engine_.Storage(), kShort.lease_s);
  const auto number = dead.Offer("a", "boat-1", "task");
  const auto jobs = engine_.Storage().Open(JobsSchema());
  while (IntegerOf(*jobs, "SELECT COUNT(*) AS value FROM jobs WHERE number = $1", {number}) > 0) {
    worker.Take();
  }
}

TEST_F(TakenJobsTest, KnowWhichWorkersAreAliveAndOfThisVersion) {
  {
    TakenJobs ends(engine_.Storage(), "ends", kLong);
    EXPECT_EQ(offered_.Workers(), 1);
  }
  EXPECT_EQ(offered_.Workers(), 0);
  TakenJobs silent(engine_.Storage(), "silent", kShort);
  while (offered_.Workers() > 0) {
  }
  TakenJobs other(engine_.Storage(), "other", kLong);
  offered_.Offer("a", "boat-1", "task");
  const auto database = engine_.Storage().Open(JobsSchema());
  database->Execute("UPDATE workers SET version = 'another'");
  database->Execute("UPDATE jobs SET version = 'another'");
  EXPECT_EQ(offered_.Workers(), 0);
  EXPECT_FALSE(other.Take());
}

// ---- as a daemon has them
// ------------------------------------------------------------------------

class HeavyJobsTest : public TakenJobsTest {
 protected:
  static IdentificationTask SomeTask() {
    IdentificationTask task;
    task.request.correlation_id = "a";
    task.request.vehicle_id = "boat-1";
    task.vehicle = YellowfishVehicle();
    return task;
  }

  /// The reports end it where `what` says so.
  static Computation Reporting(const Progress& report) {
    return Computation(Urgency::kInteractive, report);
  }
};

TEST_F(HeavyJobsTest, AreGivenUpWhereNoWorkerFinishesThem) {
  const WorkerSettings once{.lease_s = kShort.lease_s, .attempts = 1};
  TakenJobs alive(engine_.Storage(), "alive", kLong);
  TakenJobs dying(engine_.Storage(), "dying", once);
  HeavyJobs jobs("identification", &offered_, once);
  bool taken = false;
  const auto report = [&](std::string_view, double) { taken = taken || dying.Take().has_value(); };
  try {
    (void)jobs(SomeTask(), Reporting(report));
    ADD_FAILURE() << "it has an outcome";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("none has finished it"));
  }
  EXPECT_TRUE(taken);
  EXPECT_EQ(jobs.Activity().given_up, 1u);
  EXPECT_FALSE(alive.Take()) << "it is offered no more";
}

TEST_F(HeavyJobsTest, AreWithdrawnWhereNobodyWaits) {
  struct Abandoned {};
  TakenJobs worker(engine_.Storage(), "worker", kLong);
  HeavyJobs jobs("identification", &offered_, kLong);
  EXPECT_THROW(
      (void)jobs(SomeTask(), Reporting([](std::string_view, double) { throw Abandoned(); })),
      Abandoned);
  EXPECT_FALSE(worker.Take());
}

// An empty recording is refused at once, wherever that is found.
TEST_F(HeavyJobsTest, AreComputedHereWhereNoWorkerIsAlive) {
  HeavyJobs jobs("identification", &offered_, kLong);
  const auto refused = jobs(SomeTask(), Reporting([](std::string_view, double) {}));
  EXPECT_FALSE(refused);
  EXPECT_EQ(jobs.Activity().computed_here, 1u);
}

TEST_F(HeavyJobsTest, HaveTheOutcomeOfTheWorker) {
  TakenJobs worker(engine_.Storage(), "worker", kLong);
  HeavyJobs jobs("identification", &offered_, kLong);
  const Refusal refusal{"boat-1", "has sent nothing", "wait"};
  const auto report = [&](std::string_view, double) {
    if (const auto job = worker.Take()) {
      worker.Answer(*job, PackOutcome(Result<AssessedModel>(tl::unexpected(refusal))));
    }
  };
  const auto refused = jobs(SomeTask(), Reporting(report));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), refusal);
  EXPECT_EQ(jobs.Activity().answered, 1u);
  EXPECT_EQ(jobs.Activity().computed_here, 0u);
}

}  // namespace
}  // namespace telltale
