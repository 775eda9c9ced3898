#pragma once

#include <optional>
#include <string>

#include "telltale/client/workbench/names.hpp"
#include "telltale/core/data/preparation.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

const OptionNames& PresetNames();

/// "robust" or "paper". Throws: UsageError for any other name.
Preset PresetNamed(const std::string& name);
PrepareOptions PrepareOptionsOf(Preset preset);

/// Those that the model was made with, unless another preset is asked for by its name.
PrepareOptions PrepareOptionsOf(const Identification& model,
                                const std::optional<std::string>& preset = {});

}  // namespace telltale
