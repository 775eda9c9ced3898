#pragma once

#include <filesystem>
#include <memory>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/vehicle.hpp"
#include "telltale/idl/codec/mapping_file.hpp"

namespace telltale {

/// A vehicle file. Throws: FileError naming file, line, field, value and range.
Vehicle LoadVehicle(const std::filesystem::path& file);

/// A mapping file. Throws: as LoadVehicle.
std::shared_ptr<const Mapping> LoadMapping(const std::filesystem::path& file);

/// model.json. Throws: FileError naming file, field, value and what is allowed.
Identification LoadModel(const std::filesystem::path& file);

}  // namespace telltale
