#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "telltale/core/base/result.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/service/tasks/diagnosis_task.hpp"
#include "telltale/service/tasks/identification_task.hpp"

namespace telltale {

using HeavyTask = std::variant<IdentificationTask, DiagnosisTask>;

/// The task as a blob of proto/heavy_job.proto, compressed and with a checksum. It has no deadline:
/// who waits for it cancels it. Settings of the daemon go along as far as they decide the result.
std::string PackTask(const IdentificationTask& task);
std::string PackTask(const DiagnosisTask& task);

/// The way back. Whoever computes it has all processors. Refuses a damaged blob, what is no task,
/// and what the readers of its parts refuse.
Decoded<HeavyTask> UnpackTask(std::string_view blob);

/// What became of a task, likewise. `failed` says why nothing did.
std::string PackOutcome(const Result<AssessedModel>& outcome);
std::string PackOutcome(const Result<DiagnosedModel>& outcome);
std::string PackFailure(std::string_view failed);

/// The way back. Throws std::runtime_error with the words of PackFailure(), or where the blob is
/// damaged or is no outcome of this kind of task.
Result<AssessedModel> UnpackOutcome(std::string_view blob, const IdentificationTask& task);
Result<DiagnosedModel> UnpackOutcome(std::string_view blob, const DiagnosisTask& task);

}  // namespace telltale
