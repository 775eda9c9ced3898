#include "telltale/service/monitoring/daemon_log.hpp"

#include <fcntl.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <future>
#include <system_error>
#include <thread>
#include <utility>

#include <spdlog/async.h>
#include <spdlog/async_logger.h>
#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/sinks/null_sink.h>
#include <spdlog/spdlog.h>

namespace telltale {
namespace {

using Pool = spdlog::details::thread_pool;

constexpr const char* kName = "telltaled";

/// A console that says before a line how many were left out before it. The pool is the one whose
/// thread writes to it.
class CountingSink : public spdlog::sinks::ansicolor_sink<spdlog::details::console_mutex> {
 public:
  CountingSink(std::FILE* file, Pool& pool)
      : ansicolor_sink(file, spdlog::color_mode::automatic), pool_(pool) {}

  void log(const spdlog::details::log_msg& message) override {
    SayLeftOut(pool_.overrun_counter());
    ansicolor_sink::log(message);
  }

 private:
  void SayLeftOut(std::size_t in_all) {
    const std::size_t newly = in_all - std::exchange(said_, in_all);
    if (newly == 0) return;
    const std::string text =
        fmt::format("{} older lines are left out: nobody read the log in time", newly);
    ansicolor_sink::log(spdlog::details::log_msg(kName, spdlog::level::warn, text));
  }

  Pool& pool_;
  std::size_t said_ = 0;
};

/// A stream of its own: the end of a process waits for the lock of `stderr`, which a thread that
/// cannot write would hold.
std::FILE* StreamTo(int descriptor) {
  std::FILE* const file = fdopen(fcntl(descriptor, F_DUPFD_CLOEXEC, 0), "w");
  if (file == nullptr) throw std::system_error(errno, std::generic_category(), "opening the log");
  setvbuf(file, nullptr, _IONBF, 0);
  return file;
}

/// A signal whose handler is to run on a thread that waits for its reader may never be handled.
void TakeNoSignals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

}  // namespace

DaemonLog::DaemonLog(int descriptor, std::size_t most_waiting)
    : file_(StreamTo(descriptor)),
      writing_(std::make_shared<Pool>(most_waiting, 1, TakeNoSignals)) {
  spdlog::set_default_logger(std::make_shared<spdlog::async_logger>(
      kName, std::make_shared<CountingSink>(file_, *writing_), writing_,
      spdlog::async_overflow_policy::overrun_oldest));
}

/// The pool ends once all is written, which may be never: a thread that the process does not wait
/// for sees to it.
DaemonLog::~DaemonLog() {
  constexpr std::chrono::seconds kPatience{2};
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>(kName, std::make_shared<spdlog::sinks::null_sink_mt>()));
  std::promise<void> written;
  const auto ended = written.get_future();
  std::thread([pool = std::move(writing_), written = std::move(written)]() mutable {
    pool.reset();
    written.set_value();
  }).detach();
  if (ended.wait_for(kPatience) == std::future_status::ready) std::fclose(file_);
}

}  // namespace telltale
