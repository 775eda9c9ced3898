#pragma once

#include <vector>

#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"
#include "telltale/core/diagnosis/hypotheses/ranking.hpp"
#include "telltale/core/diagnosis/report/diagnosis.hpp"

namespace telltale {

/// Which manoeuvres of the catalogue would tell a tied explanation from those that predict the
/// same on this recording, best first: the nats between what they predict of two minutes of each,
/// docs/concepts/diagnosis.md (96). None where nothing is tied.
std::vector<SeparationAdvice> AdviseSeparatingManoeuvres(const RankedHypothesis& hypothesis,
                                                         const NominalBaseline& nominal,
                                                         double sampling_period_s,
                                                         const HullParticulars& hull);

/// What would settle it where no manoeuvre is promised to: sensors.
std::string AdviseSensor(const RankedHypothesis& hypothesis);

}  // namespace telltale
