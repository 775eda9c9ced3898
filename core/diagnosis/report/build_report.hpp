#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/hypotheses/power.hpp"
#include "telltale/core/diagnosis/report/conclusion.hpp"
#include "telltale/core/diagnosis/report/horizon_gap.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// What a report is built from. The referenced objects have to outlive it.
struct ReportInputs {
  const PreparedDataset& recording;
  const std::vector<PreparedDataset>& references;
  const UncertainModel& model;
  std::span<const Effect* const> library;
  const std::vector<HorizonErrors>& horizons;
  const HorizonErrors& main;  ///< that of the main horizon
  const DiagnosisProblem& problem;
  const Hypotheses& hypotheses;
  const Conclusion& conclusion;
  const DayToDay& days;  ///< what nominal days leave
  const std::vector<DelayDifference>& delays;
  bool advise = true;       ///< manoeuvres that separate equivalent hypotheses
  bool state_power = true;  ///< the sizes from which on effects show
  std::uint64_t seed = 1;
  std::size_t threads = 1;
};

/// The diagnosis as a report lists it: gaps, testability, and, where the gap is material, its
/// places, causes and advice. Vehicle, references, improvement and sentence are left to Diagnose().
Diagnosis BuildReport(const ReportInputs& inputs);

}  // namespace telltale
