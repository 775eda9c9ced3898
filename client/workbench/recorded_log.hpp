#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "telltale/client/recording/load_recording.hpp"
#include "telltale/client/recording/source_log.hpp"
#include "telltale/client/workbench/note_sink.hpp"
#include "telltale/core/data/samples.hpp"

namespace telltale {

/// One log: what of it can be trusted.
struct RecordedLog {
  std::filesystem::path path;  ///< by which errors name it
  LoadedRecording loaded;
  std::optional<Refusal> fault;  ///< of input, where it was sought and found
};

/// "run225" of /data/run225 and of /data/run225/.
std::string NameOf(const std::filesystem::path& log);

/// One log before any admission; channels may be missing. Throws: RefusedError naming the log,
/// UsageError where its format does not record an output that is asked for.
RawLog LoadAsRecorded(const std::filesystem::path& log, const SourceOptions& options);

/// What is admitted of a log, with notes on what is not. Throws: RefusedError naming the log.
RecordedLog Admitted(const std::filesystem::path& path, RawLog log, const NoteSink& note);

/// LoadAsRecorded, then Admitted.
RecordedLog LoadLog(const std::filesystem::path& path, const SourceOptions& options,
                    const NoteSink& note);

/// What can be trusted of a log, alone.
Recording LoadAdmitted(const std::filesystem::path& path, const SourceOptions& options,
                       const NoteSink& note);

}  // namespace telltale
