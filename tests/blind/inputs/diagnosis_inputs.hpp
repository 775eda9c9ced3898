#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace blind {

/// What `telltale diagnose` is given: a model, a recording, recordings of when all was well.
struct DiagnosisInputs {
  telltale::UncertainModel model;
  telltale::PreparedDataset recording;
  std::vector<telltale::PreparedDataset> references;
};

/// The same as files, read and prepared as `telltale diagnose` does.
struct DiagnosisInputFiles {
  std::filesystem::path log;
  std::filesystem::path vehicle;
  std::filesystem::path model;
  std::vector<std::filesystem::path> references;

  void AddTo(CLI::App& app);

  /// Throws: as the command's readers, or telltale::RefusedError where the data cannot answer.
  DiagnosisInputs Load() const;
};

}  // namespace blind
