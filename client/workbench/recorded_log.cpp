#include "telltale/client/workbench/recorded_log.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "telltale/client/recording/dataflash/dataflash_log.hpp"
#include "telltale/client/workbench/errors.hpp"

namespace telltale {
namespace {

void NoteMalformed(const std::filesystem::path& file, const MalformedRows& malformed,
                   const NoteSink& note) {
  if (malformed.count == 0) return;
  std::string text = file.string() + ": " + std::to_string(malformed.count) +
                     " malformed rows skipped, first in line";
  for (const std::size_t line : malformed.first_lines) text += ' ' + std::to_string(line);
  note(text);
}

/// Channels that the format of a log does not record are an error of the request.
void RequireRecordedChannels(const std::filesystem::path& log, const SourceOptions& options) {
  const std::array named = {std::pair("--port-channel", options.port_channel),
                            std::pair("--starboard-channel", options.starboard_channel)};
  for (const auto& [option, channel] : named) {
    if (!options.mapping || !channel) continue;
    throw UsageError(std::string(option) +
                     ": the mapping names the outputs; leave one of them out");
  }
  if (FormatOf(log) != LogFormat::kDataFlash) return;
  for (const auto& [option, channel] : named) {
    if (channel.value_or(1) <= kLoggedChannels) continue;
    throw UsageError(std::string(option) + ": " + log.string() + " records channels 1 to " +
                     std::to_string(kLoggedChannels) + ", not " + std::to_string(*channel));
  }
}

}  // namespace

std::string NameOf(const std::filesystem::path& log) {
  return (log.has_filename() ? log : log.parent_path()).filename().string();
}

RawLog LoadAsRecorded(const std::filesystem::path& log, const SourceOptions& options) {
  RequireRecordedChannels(log, options);
  return OrThrow(ReadLog(log, options));
}

RecordedLog Admitted(const std::filesystem::path& path, RawLog log, const NoteSink& note) {
  LoadedRecording loaded = OrThrow(AdmitLog(path, std::move(log)));
  if (loaded.description) note(path.string() + ": " + loaded.description->summary);
  for (const Channel channel : kChannels) {
    NoteMalformed(path / (std::string(Name(channel)) + ".csv"),
                  loaded.malformed[static_cast<std::size_t>(channel)], note);
  }
  if (loaded.evicted > 0) {
    note(path.string() + ": " + std::to_string(loaded.evicted) +
         " samples left out, older than a day or before the clock was set back");
  }
  return {path, std::move(loaded), std::nullopt};
}

RecordedLog LoadLog(const std::filesystem::path& path, const SourceOptions& options,
                    const NoteSink& note) {
  return Admitted(path, LoadAsRecorded(path, options), note);
}

Recording LoadAdmitted(const std::filesystem::path& path, const SourceOptions& options,
                       const NoteSink& note) {
  return LoadLog(path, options, note).loaded.recording;
}

}  // namespace telltale
