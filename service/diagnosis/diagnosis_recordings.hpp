#pragma once

#include <optional>
#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// The recordings of a live diagnosis of a model.
struct DiagnosisRecordings {
  Recording since;                    ///< after the model was made, or after its drift began
  std::optional<Recording> baseline;  ///< that made the model, where a minute or more is at hand
  std::string basis;                  ///< what the baseline error rests on, for the notes
  std::string left_out;               ///< what else the notes are to say; empty: nothing
};

/// Splits the window of a vehicle at the end of the data behind the model.
/// `behind` is the recording that made the model, where the daemon still holds it. Otherwise the
/// part of the window up to that time is the baseline.
/// `drift_onset_s`, by the vehicle's clock: where a minute or more has come since then, what came
/// before is left out, since the vehicle was another then.
/// Assumes another clock where the window ends before the data behind the model do: all of the
/// window then counts as recorded since.
/// Refuses when: less than a minute has been recorded since the model was made.
Result<DiagnosisRecordings> SelectDiagnosisRecordings(const Recording& window,
                                                      const PublishedModel& model,
                                                      const std::optional<Recording>& behind,
                                                      std::optional<double> drift_onset_s = {});

}  // namespace telltale
