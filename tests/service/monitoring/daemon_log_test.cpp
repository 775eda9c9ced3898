#include "telltale/service/monitoring/daemon_log.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <regex>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr int kLines = 5000;

/// A pipe of a page. Nobody reads it until ReadAll().
class UnreadPipe {
 public:
  UnreadPipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) ADD_FAILURE() << "no pipe";
    fcntl(ends_[0], F_SETPIPE_SZ, 1);
  }
  UnreadPipe(const UnreadPipe&) = delete;
  UnreadPipe& operator=(const UnreadPipe&) = delete;
  ~UnreadPipe() { close(ends_[0]); }

  int end() const { return ends_[1]; }
  void CloseEnd() { close(ends_[1]); }

  /// All that is written until every end is closed.
  std::string ReadAll() const {
    std::string text;
    std::array<char, 4096> buffer{};
    ssize_t count = 0;
    while ((count = read(ends_[0], buffer.data(), buffer.size())) > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return text;
  }

 private:
  std::array<int, 2> ends_{};
};

/// Leaves the logger of the other tests as it was.
class DaemonLogTest : public ::testing::Test {
 protected:
  ~DaemonLogTest() override { spdlog::set_default_logger(before_); }

  const std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
};

TEST_F(DaemonLogTest, KeepsTheNewestLinesAndCountsTheOthersWhileNobodyReads) {
  UnreadPipe pipe;
  auto log = std::make_unique<DaemonLog>(pipe.end(), 16);
  for (int line = 0; line < kLines; ++line) spdlog::warn("line {} of many", line);
  std::string text;
  std::thread reading([&] { text = pipe.ReadAll(); });
  log.reset();
  pipe.CloseEnd();
  reading.join();

  const auto count_of = [&](const std::regex& what) {
    return std::distance(std::sregex_iterator(text.begin(), text.end(), what),
                         std::sregex_iterator());
  };
  int left_out = 0;
  const std::regex note("(\\d+) older lines are left out");
  for (std::sregex_iterator found(text.begin(), text.end(), note); found != std::sregex_iterator();
       ++found) {
    left_out += std::stoi((*found)[1]);
  }
  EXPECT_GT(left_out, 0);
  EXPECT_EQ(count_of(std::regex("line \\d+ of many")) + left_out, kLines);
  EXPECT_THAT(text, HasSubstr("line 4999 of many"));
}

}  // namespace
}  // namespace telltale
