#pragma once

#include <optional>
#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// What a live diagnosis is about: a model, what the boat has done since it was made, and what it
/// did when it was made.
struct DiagnosisRecordings {
  Recording since;
  std::optional<Recording> baseline;
  std::string basis;  ///< what the baseline error rests on, for the notes
};

/// `behind` is the recording behind the model, where it is at hand; else the part of the window
/// that made the model stands in for it, where a minute or more of that is still held. A window
/// that ends before the model's data do is of another clock, and all of it counts as since.
/// Refuses when: less than a minute has been recorded since the model was made.
Result<DiagnosisRecordings> SelectDiagnosisRecordings(const Recording& window,
                                                      const PublishedModel& model,
                                                      const std::optional<Recording>& behind);

}  // namespace telltale
