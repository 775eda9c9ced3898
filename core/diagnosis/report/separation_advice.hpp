#pragma once

#include <string>
#include <vector>

#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"

namespace telltale {

/// The manoeuvres of the catalogue that separate a hypothesis from its equivalents, by the log
/// evidence expected of two minutes of each, docs/concepts/diagnosis.md (96). A manoeuvre counts by
/// the equivalent that it separates least. None where the hypothesis has no equivalents.
std::vector<SeparationAdvice> AdviseSeparatingManoeuvres(const RankedHypothesis& hypothesis,
                                                         const NominalBaseline& nominal,
                                                         double sampling_period_s,
                                                         const HullParticulars& hull);

/// Those with at least kDiagnosis.separation.minimum_nats, most first, kDiagnosis.separation
/// .most_advice at the most.
std::vector<SeparationAdvice> MostSeparating(std::vector<SeparationAdvice> advice);

/// A sentence naming the sensor that measures the hypothesis' first effect.
std::string AdviseSensor(const RankedHypothesis& hypothesis);

}  // namespace telltale
