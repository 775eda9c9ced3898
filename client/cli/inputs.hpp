#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "data/preparation.hpp"
#include "data/samples.hpp"
#include "identification/identification.hpp"
#include "vessel/vehicle.hpp"

namespace telltale {

/// A vehicle file. Throws: std::runtime_error naming file, line, field, value and range.
Vehicle LoadVehicle(const std::filesystem::path& file);

/// model.json. Throws: std::runtime_error naming file, field, value and what is allowed.
Identification LoadModel(const std::filesystem::path& file);

/// One recording of all logs, admitted one by one and put one after the other (Concatenate). Rows
/// that could not be read are noted on standard error. Throws: RefusedError naming the log.
Recording LoadRecording(const std::vector<std::filesystem::path>& logs);

/// "robust" or "paper".
Preset PresetNamed(const std::string& name);
PrepareOptions PrepareOptionsOf(Preset preset);

/// Tells on standard error when a model was identified on another vehicle.
void NoteOtherVehicle(const Identification& model, const Vehicle& vehicle);

}  // namespace telltale
