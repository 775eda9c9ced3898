#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/output_options.hpp"
#include "telltale/core/identification/options.hpp"

namespace telltale {

/// What `telltale identify` was asked. Options left unset take the default of whoever identifies.
struct IdentifyArguments {
  LogInputs inputs;
  std::optional<std::string> structure;         ///< auto, static, dynamic, fossen
  std::optional<std::string> parameterization;  ///< propeller, paper
  std::optional<std::string> dead_zone;         ///< identify, or FORWARD,REVERSE
  std::optional<std::string> estimator;         ///< auto, weak-iv, output-error, one-step
  std::optional<std::string> preset;            ///< robust, paper
  std::optional<double> sampling_period_s;
  std::optional<std::size_t> parametric_replicates;
  std::optional<std::uint32_t> bootstrap_replicates;
  std::optional<std::string> bootstrap_kind;  ///< slices, moving-blocks, parametric
  std::optional<std::string> interval;        ///< percentile, studentized, bca
  std::optional<std::string> recording_bias;  ///< shared, per-recording, per-recording-ned
  std::optional<double> interval_level;
  std::uint64_t seed = 1;
  std::optional<std::size_t> threads;
  std::uint32_t coverage_check_replicates = 0;
  bool include_rr = false;
  bool discrete = false;
  OutputOptions output;

  /// The options that say how to identify and how to answer, but not whom.
  void AddOptionsTo(CLI::App& command);

  /// Throws: UsageError for what this version cannot do, or a value out of its range.
  IdentifyOptions Options() const;

  /// Whether the data are to choose the structure: none is named, nor an option of one alone.
  bool LeaveStructureToData() const;

 private:
  bool AskForBootstrap() const;

  /// The first option given that the physical form has no use for.
  std::optional<std::string_view> OptionOfFreeCoefficients() const;

  RecordingBiasModel ChosenRecordingBias() const;

  /// The one named, else what the other options ask for; none: by the data. Throws: UsageError
  /// where they contradict.
  std::optional<Estimator> ChosenEstimator() const;
};

}  // namespace telltale
