#include "telltale/service/jobs/request_journal.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "service/jobs/request_called.hpp"
#include "service/storage_fixture.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

class RequestJournalTest : public StorageTest {
 protected:
  /// Runs `work` while nobody else writes requests: who tries waits.
  void WhileTheDatabaseHangs(const std::function<void()>& work) const {
    const auto other = Storage().Open(RequestsSchema());
    other->InTransaction([&] {
      if (GetParam() == Engine::kPostgres) {
        other->Execute("LOCK TABLE requests IN EXCLUSIVE MODE");
      }
      work();
    });
  }

  /// The requests that a daemon finds after its restart.
  std::vector<std::string> Unanswered() const {
    std::vector<std::string> ids;
    for (const auto& [request, attempts] : RequestJournal(Storage()).TakeUnanswered()) {
      ids.push_back(CorrelationIdOf(request));
    }
    return ids;
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, RequestJournalTest, kEngines, EngineName);

TEST_P(RequestJournalTest, KeepsWhatHasNoAnswer) {
  {
    RequestJournal journal(Storage());
    for (const char* id : {"first", "second", "third"}) journal.Keep(RequestCalled(id), {});
    journal.Drop("second");
    journal.Drop("stranger");
  }
  EXPECT_EQ(Unanswered(), (std::vector<std::string>{"first", "third"}));
}

TEST_P(RequestJournalTest, ForgetsARequestOfTheRunBeforeOnceItIsAnswered) {
  RequestJournal(Storage()).Keep(RequestCalled("earlier"), {});
  {
    RequestJournal journal(Storage());
    ASSERT_EQ(journal.TakeUnanswered().size(), 1u);
    WhileTheDatabaseHangs([&] {
      journal.Keep(RequestCalled("earlier"), {});
      journal.Drop("earlier");
    });
  }
  EXPECT_EQ(Unanswered(), std::vector<std::string>());
}

// Not those that wait behind it, and not one that is new.
TEST_P(RequestJournalTest, CountsTheAttemptsToAnswerARequestOfARunBefore) {
  RequestJournal(Storage()).Keep(RequestCalled("ends-the-daemon"), {});
  RequestJournal(Storage()).Keep(RequestCalled("waits"), {});
  for (int attempt = 0; attempt < 2; ++attempt) {
    RequestJournal journal(Storage());
    journal.TakeUnanswered();
    journal.Keep(RequestCalled("ends-the-daemon"), {});
    journal.CountAttempt("ends-the-daemon");
    journal.Keep(RequestCalled("new"), {});
    journal.CountAttempt("new");
    journal.Drop("new");
  }
  const auto unanswered = RequestJournal(Storage()).TakeUnanswered();
  ASSERT_EQ(unanswered.size(), 2u);
  EXPECT_EQ(unanswered[0].attempts, 2);
  EXPECT_EQ(unanswered[1].attempts, 0);
}

// One sum of two daemons that stand in for each other, whichever of them ended.
TEST_P(RequestJournalTest, CountsTheAttemptsOfAnotherDaemonToo) {
  const AnyRequest request = RequestCalled("ends-both");
  {
    RequestJournal journal(Storage());
    EXPECT_EQ(journal.CountAttemptOfAnother(request), 1);
    journal.Keep(request, {});
    journal.CountAttempt("ends-both");
  }
  {
    RequestJournal journal(Storage());
    const auto unanswered = journal.TakeUnanswered();
    ASSERT_EQ(unanswered.size(), 1u);
    EXPECT_EQ(unanswered[0].attempts, 2);
    EXPECT_EQ(journal.CountAttemptOfAnother(request), 3);
    journal.Drop("ends-both");
  }
  EXPECT_EQ(Unanswered(), std::vector<std::string>());
}

TEST_P(RequestJournalTest, HoldsNoMoreThanHasNoAnswerWhileTheDatabaseHangs) {
  std::atomic<int> kept = 0;
  {
    RequestJournal journal(Storage());
    WhileTheDatabaseHangs([&] {
      journal.Keep(RequestCalled("stays"), [&] { ++kept; });
      for (int i = 0; i < 1000; ++i) {
        const std::string id = "goes-" + std::to_string(i);
        journal.Keep(RequestCalled(id), {});
        journal.Keep(RequestCalled(id), {});  // somebody asks again
        journal.Drop(id);
      }
      EXPECT_LE(journal.Waiting(), 2u);  // and what the thread tries to write
      EXPECT_EQ(kept, 0);
    });
  }
  EXPECT_EQ(kept, 1);
  EXPECT_EQ(Unanswered(), std::vector<std::string>{"stays"});
}

}  // namespace
}  // namespace telltale
