#pragma once

#include <functional>
#include <optional>
#include <string>

namespace telltale {

/// A stream of running boats that becomes telemetry.
class LiveSource {
 public:
  using Report = std::function<void(const std::string& what)>;

  LiveSource() = default;
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;
  virtual ~LiveSource() = default;

  /// Receives until Stop(), and calls `second` each second, on this thread. Throws BusError.
  virtual void Run(const std::function<void()>& second) = 0;

  /// Ends Run(), also one that is yet to begin. Any thread may call it.
  virtual void Stop() = 0;

  /// Why nothing can be received now; nothing where it can. From the thread of Run() alone.
  virtual std::optional<std::string> Fault() const = 0;
};

}  // namespace telltale
