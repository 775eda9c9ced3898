#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "telltale/core/base/result.hpp"
#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// What the command exits with.
enum class ExitCode : int {
  kSuccess = 0,
  kFailure = 1,  ///< a file, the network, the daemon
  kUsage = 2,    ///< the command line
  kRefused = 3,  ///< the data cannot answer
};

/// Thrown by a subcommand where a refusal, in place of what was asked, is its answer.
class RefusedError : public std::runtime_error {
 public:
  explicit RefusedError(Refusal refusal)
      : std::runtime_error(refusal.reason), refusal_(std::move(refusal)) {}
  const Refusal& Answer() const { return refusal_; }

 private:
  Refusal refusal_;
};

/// Thrown by a subcommand whose options are wrong in a way the parser cannot see.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value, or the refusal thrown.
template <class T>
T OrThrow(Result<T> result) {
  if (!result) throw RefusedError(result.error());
  return *std::move(result);
}

/// The value, or the codec's error thrown as a failure.
template <class T>
T OrThrow(Decoded<T> decoded) {
  if (!decoded) throw std::runtime_error(decoded.error().Message());
  return *std::move(decoded);
}

/// "subject: reason" and, on a line of its own, what to do about it; wrapped for a terminal.
std::string Explained(const Refusal& refusal);

}  // namespace telltale
