#include "telltale/service/web/path_predictions.hpp"

#include <atomic>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace telltale {
namespace {

using Clock = PathPredictions::Clock;

Result<PredictedPaths> PathsOver(double horizon_s) {
  PredictedPaths paths;
  paths.horizon_s = horizon_s;
  return paths;
}

TEST(PathPredictions, AnswerTheSameQuestionOnce) {
  PathPredictions predictions;
  int computed = 0;
  const auto predict = [&] { return PathsOver(++computed); };
  const auto first = predictions.Ask({"boat", 1, 180, 60}, predict);
  EXPECT_EQ(predictions.Ask({"boat", 1, 180, 60}, predict), first);
  EXPECT_EQ(computed, 1);
}

TEST(PathPredictions, AnotherBoatModelOrSpanIsAnotherQuestion) {
  PathPredictions predictions;
  int computed = 0;
  const std::vector<PathPredictions::Question> questions = {{"boat", 1, 180, 60},
                                                            {"buoy", 1, 180, 60},
                                                            {"boat", 2, 180, 60},
                                                            {"boat", 1, 181, 60},
                                                            {"boat", 1, 180, 61}};
  for (const auto& question : questions) {
    const auto answer = predictions.Ask(question, [&] { return PathsOver(++computed); });
    ASSERT_TRUE(answer && *answer);
    EXPECT_EQ((*answer)->horizon_s, computed);
  }
}

TEST(PathPredictions, ComputeOneAtATime) {
  PathPredictions predictions(std::chrono::minutes(1));
  std::atomic<int> at_once = 0;
  std::atomic<int> most_at_once = 0;
  std::vector<std::thread> clients;
  for (std::uint64_t i = 0; i < 8; ++i) {
    clients.emplace_back([&, i] {
      predictions.Ask({"boat", i, 180, 60}, [&] {
        most_at_once = std::max(most_at_once.load(), ++at_once);
        std::this_thread::yield();
        --at_once;
        return PathsOver(60.0);
      });
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(most_at_once, 1);
}

TEST(PathPredictions, RestThreeTimesAsLongAsTheyCompute) {
  PathPredictions predictions(std::chrono::minutes(1));
  Clock::time_point begun;
  Clock::time_point ended;
  predictions.Ask({"boat", 1, 180, 60}, [&] {
    begun = Clock::now();
    while (Clock::now() < begun + std::chrono::milliseconds(5)) std::this_thread::yield();
    ended = Clock::now();
    return PathsOver(60.0);
  });
  predictions.Ask({"boat", 2, 180, 60}, [&] {
    EXPECT_GE(Clock::now() - ended, 3 * (ended - begun));
    return PathsOver(60.0);
  });
}

TEST(PathPredictions, GiveNothingToWhoGetsNoTurn) {
  PathPredictions predictions(std::chrono::milliseconds(0));
  std::promise<void> begun;
  std::promise<void> may_end;
  std::thread slow([&] {
    predictions.Ask({"boat", 1, 180, 60}, [&] {
      begun.set_value();
      may_end.get_future().wait();
      return PathsOver(60.0);
    });
  });
  begun.get_future().wait();
  EXPECT_EQ(predictions.Ask({"boat", 2, 180, 60}, [] { return PathsOver(60.0); }), nullptr);
  may_end.set_value();
  slow.join();
}

TEST(PathPredictions, AFaultEndsItsTurn) {
  PathPredictions predictions(std::chrono::minutes(1));
  const auto fail = []() -> Result<PredictedPaths> { throw std::runtime_error("no memory"); };
  EXPECT_THROW(predictions.Ask({"boat", 1, 180, 60}, fail), std::runtime_error);
  EXPECT_NE(predictions.Ask({"boat", 1, 180, 60}, [] { return PathsOver(60.0); }), nullptr);
}

}  // namespace
}  // namespace telltale
