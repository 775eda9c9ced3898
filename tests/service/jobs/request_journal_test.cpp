#include "telltale/service/jobs/request_journal.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

class RequestJournalTest : public StorageTest {
 protected:
  static AnyRequest RequestCalled(const std::string& correlation_id) {
    IdentifyRequest request;
    request.correlation_id = correlation_id;
    request.vehicle_id = "boat";
    return request;
  }

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
    for (const AnyRequest& request : RequestJournal(Storage()).TakeUnanswered()) {
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
