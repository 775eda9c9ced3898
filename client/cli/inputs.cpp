#include "cli/inputs.hpp"

#include <iostream>
#include <stdexcept>

#include "cli/outcome.hpp"
#include "codec/model_json.hpp"
#include "codec/vehicle_file.hpp"
#include "contract.hpp"
#include "recording/files.hpp"
#include "recording/load.hpp"
#include "recording/telemetry_log.hpp"

namespace telltale {
namespace {

std::string TextOf(const std::filesystem::path& file) {
  auto text = ReadFile(file);
  if (!text) throw std::runtime_error(text.error().subject + ' ' + text.error().reason);
  return *std::move(text);
}

void NoteMalformed(const std::filesystem::path& file, const MalformedRows& malformed) {
  if (malformed.count == 0) return;
  std::cerr << "note: " << file.string() << ": " << malformed.count
            << " malformed rows skipped, first in line";
  for (const std::size_t line : malformed.first_lines) std::cerr << ' ' << line;
  std::cerr << '\n';
}

Recording LoadLog(const std::filesystem::path& path) {
  LoadedRecording loaded = OrThrow(LoadRecording(path));
  if (loaded.dataflash) {
    std::cerr << "note: " << path.string() << ": " << loaded.dataflash->report.Summary() << '\n';
  }
  for (const Channel channel : kChannels) {
    NoteMalformed(path / (std::string(Name(channel)) + ".csv"),
                  loaded.malformed[static_cast<std::size_t>(channel)]);
  }
  if (loaded.forgotten > 0) {
    std::cerr << "note: " << path.string() << ": " << loaded.forgotten
              << " samples left out, older than a day or before the clock was set back\n";
  }
  return std::move(loaded.recording);
}

}  // namespace

Vehicle LoadVehicle(const std::filesystem::path& file) {
  return OrThrow(ParseVehicle(TextOf(file), file.string()));
}

Identification LoadModel(const std::filesystem::path& file) {
  return OrThrow(ParseModelJson(TextOf(file), file.string()));
}

Recording LoadRecording(const std::vector<std::filesystem::path>& logs) {
  std::vector<Recording> recordings;
  for (const std::filesystem::path& log : logs) recordings.push_back(LoadLog(log));
  return Concatenate(recordings);
}

Preset PresetNamed(const std::string& name) {
  Require(name == "robust" || name == "paper", "the name of a preset");
  return name == "paper" ? Preset::kPaper : Preset::kRobust;
}

PrepareOptions PrepareOptionsOf(Preset preset) {
  return preset == Preset::kPaper ? PrepareOptions::Paper() : PrepareOptions::Robust();
}

void NoteOtherVehicle(const Identification& model, const Vehicle& vehicle) {
  if (model.vehicle_id == vehicle.vehicle_id) return;
  std::cerr << "note: the model is of " << model.vehicle_id << ", the vehicle file of "
            << vehicle.vehicle_id << '\n';
}

}  // namespace telltale
