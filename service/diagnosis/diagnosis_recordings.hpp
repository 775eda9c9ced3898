#pragma once

#include <optional>
#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// The recordings of a live diagnosis of a model.
struct DiagnosisRecordings {
  Recording since;                    ///< after the model was made
  std::optional<Recording> baseline;  ///< that made the model, where a minute or more is at hand
  std::string basis;                  ///< what the baseline error rests on, for the notes
};

/// Splits the window of a vehicle at the end of the data behind the model.
/// `behind` is the recording that made the model, where the daemon still holds it. Otherwise the
/// part of the window up to that time is the baseline.
/// Assumes another clock where the window ends before the data behind the model do: all of the
/// window then counts as recorded since.
/// Refuses when: less than a minute has been recorded since the model was made.
Result<DiagnosisRecordings> SelectDiagnosisRecordings(const Recording& window,
                                                      const PublishedModel& model,
                                                      const std::optional<Recording>& behind);

}  // namespace telltale
