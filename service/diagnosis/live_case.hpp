#pragma once

#include <optional>
#include <string>

#include "telltale/core/data/samples.hpp"
#include "telltale/core/result.hpp"
#include "telltale/idl/codec/messages.hpp"

namespace telltale {

/// What a live diagnosis is about: a model, what the boat has done since it was made, and what it
/// did when it was made.
struct LiveCase {
  Recording since;
  std::optional<Recording> healthy;
  std::string basis;  ///< what the healthy error rests on, for the notes
};

/// `behind` is the recording behind the model, where it is at hand; else the part of the window
/// that made the model stands in for it, where a minute or more of that is still held. A window
/// that ends before the model's data do is of another clock, and all of it counts as since.
/// Refuses when: less than a minute has been recorded since the model was made.
Result<LiveCase> CaseOf(const Recording& window, const PublishedModel& model,
                        const std::optional<Recording>& behind);

}  // namespace telltale
