#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "telltale/core/base/result.hpp"
#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// Thrown where a refusal, in place of what was asked, is the answer.
class RefusedError : public std::runtime_error {
 public:
  explicit RefusedError(Refusal refusal)
      : std::runtime_error(refusal.reason), refusal_(std::move(refusal)) {}
  const Refusal& Answer() const { return refusal_; }

 private:
  Refusal refusal_;
};

/// Thrown where options contradict each other or are out of their range. The text names an option
/// as the command line does, `--sampling-period`.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown where a file cannot be read or does not hold what it should.
class FileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value, or the refusal thrown.
template <class T>
T OrThrow(Result<T> result) {
  if (!result) throw RefusedError(result.error());
  return *std::move(result);
}

/// The value, or the codec's error thrown as a failure of the file.
template <class T>
T OrThrow(Decoded<T> decoded) {
  if (!decoded) throw FileError(decoded.error().Message());
  return *std::move(decoded);
}

}  // namespace telltale
