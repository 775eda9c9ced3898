#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telltale/core/diagnosis/delays/recording_delays.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/diagnosis_problem.hpp"
#include "telltale/core/diagnosis/hypotheses/hypothesis_search.hpp"
#include "telltale/core/diagnosis/residuals/horizon_runs.hpp"
#include "telltale/core/identification/uncertain_model.hpp"

namespace telltale {

/// What the diagnoses without each reference are made from.
struct InfluenceInputs {
  const std::vector<PreparedDataset>& references;
  const std::vector<std::string>& names;  ///< of the references; those without are numbered from 1
  const HorizonRuns& main;                ///< at the main horizon
  const DiagnosisProblem& problem;        ///< with all references
  const UncertainModel& model;
  std::span<const Effect* const> library;
  const Hypotheses& hypotheses;  ///< with all references
  const ComparedDelays& delays;
  std::size_t most_effects;  ///< that may act together
  std::uint64_t seed;        ///< of every random draw
  std::size_t threads;
};

/// What the references do to the answer.
struct Influences {
  std::vector<ReferenceInfluence> answers;  ///< without each reference in turn
  std::vector<LeftOutDay> days;             ///< of the references that have windows, when left out
};

/// The answer without each reference in turn, docs/concepts/diagnosis.md, "The nominal baseline".
/// To first order: the nominal boat without a reference is one Gauss-Newton step from that of all,
/// with the same slopes, and learned anew where that boat errs twice as far on the recording;
/// hypotheses are fitted anew, single effects from their values with all.
/// `report_progress` is called by one thread at a time. Requires: two references or more.
Influences InfluencesOf(const InfluenceInputs& inputs,
                        const std::function<void(double)>& report_progress);

/// Names the references without which the verdict is another; empty where there are none.
std::string DescribeInfluences(const std::vector<ReferenceInfluence>& influences, Verdict verdict);

}  // namespace telltale
