#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace telltale {

/// A refusal is an answer: the data cannot say what was asked. It names what was asked (subject),
/// why the data cannot tell (reason) and what the operator can do about it (advice).
struct Refusal {
  std::string subject;
  std::string reason;
  std::string advice;

  bool operator==(const Refusal&) const = default;
};

template <class T>
using Result = tl::expected<T, Refusal>;

inline tl::unexpected<Refusal> Refuse(std::string subject, std::string reason, std::string advice) {
  return tl::unexpected<Refusal>(Refusal{std::move(subject), std::move(reason), std::move(advice)});
}

}  // namespace telltale
