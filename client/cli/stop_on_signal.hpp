#pragma once

#include <functional>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

namespace telltale {

/// While it lives, SIGINT or SIGTERM calls `stop`, on a thread of its own, instead of ending the
/// program. Another one changes nothing.
class StopOnSignal {
 public:
  explicit StopOnSignal(std::function<void()> stop) {
    signals_.async_wait([stop = std::move(stop)](const auto& error, int) {
      if (!error) stop();
    });
    thread_ = std::thread([this] { context_.run(); });
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
  ~StopOnSignal() {
    context_.stop();
    thread_.join();
  }

 private:
  boost::asio::io_context context_;
  boost::asio::signal_set signals_{context_, SIGINT, SIGTERM};
  std::thread thread_;
};

}  // namespace telltale
