#include <signal.h>

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "support/frozen_thread.hpp"
#include "support/notify_socket.hpp"
#include "support/page_of.hpp"
#include "telltale/service/web/httplib.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

/// telltaled, and what it tells the service manager that has started it.
class SupervisedDaemon : public ServiceTest {
 protected:
  Process Start() const { return Process({TELLTALED, "--config", config_file_}); }

  static constexpr auto kWatchdog = 4s;
  NotifySocket manager_{folder_.Path() / "notify", kWatchdog};
};

TEST_F(SupervisedDaemon, IsReadyOnceItAnswers) {
  Process daemon = Start();
  ASSERT_TRUE(manager_.Await("READY=1")) << daemon.output();
  const auto list = ServiceTest::Start({"list"});
  EXPECT_EQ(list->Wait(), 0) << list->output();
  EXPECT_TRUE(manager_.Await("STATUS=serving 1 vehicles"));
}

TEST_F(SupervisedDaemon, IsNeverReadyWhereItCannotServe) {
  Process daemon = Start();
  ASSERT_TRUE(manager_.Await("READY=1")) << daemon.output();
  NotifySocket of_second(folder_.Path() / "second", kWatchdog);
  Process second = Start();
  EXPECT_EQ(second.Wait(), 1);
  EXPECT_THAT(second.output(), HasSubstr("in use"));
  while (const auto message = of_second.Next(0ms)) EXPECT_THAT(*message, Not(HasSubstr("READY")));
}

// Until it has heard nobody for a lease, it does not know whether it serves.
TEST_F(SupervisedDaemon, IsReadyOnceItKnowsItsRole) {
  Configure("standby { ownership_strength: 1 lease_s: 1 }\n");
  Process daemon = Start();
  std::string before;
  ASSERT_TRUE(manager_.Await("READY=1", &before)) << daemon.output();
  EXPECT_THAT(before, HasSubstr("STATUS=starting with 1 vehicles"));
  EXPECT_THAT(before, Not(HasSubstr("serving")));
  EXPECT_TRUE(manager_.Await("STATUS=serving 1 vehicles"));
}

TEST_F(SupervisedDaemon, SaysThatItReloadsAndThatItStops) {
  Process daemon = Start();
  ASSERT_TRUE(manager_.Await("READY=1")) << daemon.output();
  daemon.Signal(SIGHUP);
  EXPECT_TRUE(manager_.Await("RELOADING=1"));
  EXPECT_TRUE(manager_.Await("READY=1"));
  daemon.Signal(SIGTERM);
  EXPECT_TRUE(manager_.Await("STOPPING=1"));
  EXPECT_EQ(daemon.Wait(), 0) << daemon.output();
}

TEST_F(SupervisedDaemon, GivesNoSignOfLifeWhileItTakesInNothing) {
  Configure("http { port: 0 }\n");
  Process daemon = Start();
  for (int sign = 0; sign < 3; ++sign) ASSERT_TRUE(manager_.Await("WATCHDOG=1")) << daemon.output();
  ASSERT_TRUE(daemon.WaitForOutput("page is at http://"));
  httplib::Client web(PageOf(daemon.output()));
  const auto status_of = [&](const char* route) { return web.Get(route)->status; };
  EXPECT_EQ(status_of("/api/v1/ready"), 200);
  EXPECT_EQ(status_of("/api/v1/alive"), 200);
  {
    const FrozenThread ingest(daemon.id(), "ingest");
    // Until the thread counts as silent there is a sign at each look, one a second.
    constexpr int kMostStillDue = 20;
    int signs = 0;
    for (auto message = manager_.Next(kWatchdog); message && signs <= kMostStillDue;
         message = manager_.Next(kWatchdog)) {
      signs += message->starts_with("WATCHDOG");
    }
    EXPECT_LE(signs, kMostStillDue);
    EXPECT_EQ(status_of("/api/v1/alive"), 503);
  }
  EXPECT_TRUE(manager_.Await("WATCHDOG=1"));
  EXPECT_EQ(status_of("/api/v1/alive"), 200);
}

}  // namespace
}  // namespace telltale
