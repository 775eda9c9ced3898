#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "telltale/client/workbench/names.hpp"
#include "telltale/core/identification/options.hpp"

namespace telltale {

/// How to identify, in the words of a user. What is left unset takes the default of whoever
/// identifies. The options of the command line are called as the comments say.
struct IdentifyChoices {
  std::optional<std::string> structure;         ///< StructureNames(); see ChosenStructure()
  std::optional<std::string> parameterization;  ///< ParameterizationNames()
  std::optional<DeadZone> dead_zone;            ///< shares of full command
  bool identify_dead_zone = false;              ///< in place of dead_zone: by the data
  std::optional<std::string> estimator;         ///< EstimatorNames()
  std::optional<std::string> preset;            ///< PresetNames()
  std::optional<double> sampling_period_s;
  std::optional<std::size_t> parametric_replicates;   ///< --replicates
  std::optional<std::uint32_t> bootstrap_replicates;  ///< --bootstrap
  std::optional<std::string> bootstrap_kind;          ///< BootstrapKindNames()
  std::optional<std::string> interval;                ///< IntervalNames()
  std::optional<std::string> recording_bias;          ///< RecordingBiasNames()
  std::optional<double> interval_level;               ///< --level
  std::uint64_t seed = 1;
  std::optional<std::size_t> threads;           ///< unset: all of the machine
  std::uint32_t coverage_check_replicates = 0;  ///< --check-coverage
  bool include_rr = false;

  /// Of one recording, or of several joined. Throws: UsageError for a name that there is not, for
  /// what this version cannot do, or a value out of its range.
  IdentifyOptions Options(std::size_t recordings) const;

  /// Whether the data are to choose the structure: auto is named, and no option of one alone.
  bool LeaveStructureToData() const;

  bool ChooseDeadZone() const { return dead_zone || identify_dead_zone; }

 private:
  void RequireKnownNames() const;

  bool AskForBootstrap() const;

  /// The first option given that the physical form has no use for.
  std::optional<std::string_view> OptionOfFreeCoefficients() const;

  /// The one named, else free coefficients where an option of theirs is given, else the physical
  /// form. Throws: UsageError where the physical form is named beside such an option.
  Structure ChosenStructure() const;

  RecordingBiasModel ChosenRecordingBias(std::size_t recordings) const;

  /// The one named, else what the other options ask for; none: by the data. Throws: UsageError
  /// where they contradict.
  std::optional<Estimator> ChosenEstimator() const;
};

const OptionNames& StructureNames();
const OptionNames& ParameterizationNames();
const OptionNames& EstimatorNames();
const OptionNames& BootstrapKindNames();
const OptionNames& IntervalNames();
const OptionNames& RecordingBiasNames();

}  // namespace telltale
