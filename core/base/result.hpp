#pragma once

#include <optional>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace telltale {

/// States that the data cannot answer a question: what was asked (subject), why the data do not
/// answer it (reason), and what the operator can do (advice).
struct Refusal {
  std::string subject;
  std::string reason;
  std::string advice;

  bool operator==(const Refusal&) const = default;
};

template <class T>
using Result = tl::expected<T, Refusal>;

/// The value; nothing where it is refused.
template <class T>
std::optional<T> OptionalOf(Result<T> result) {
  return result ? std::optional<T>(*std::move(result)) : std::nullopt;
}

inline tl::unexpected<Refusal> Refuse(std::string subject, std::string reason, std::string advice) {
  return tl::unexpected<Refusal>(Refusal{std::move(subject), std::move(reason), std::move(advice)});
}

}  // namespace telltale
