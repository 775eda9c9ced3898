#include "telltale/core/validation/held_out_score.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/recording_parts.hpp"

namespace telltale {
namespace {

IdentifyOptions WithoutBounds(IdentifyOptions options, const Recording& training) {
  options.bootstrap_replicates = 0;
  options.posterior_draws = 100;  // the least
  options.parametric_replicates = 0;
  options.coverage_check_replicates = 0;
  options.advise = false;
  // A bias per recording takes several recordings.
  if (training.starts_s.size() < 2) options.regression.recording_bias = RecordingBiasModel::kShared;
  return options;
}

double Span(const Recording& recording) {
  return recording.gnss.back().time_s - recording.gnss.front().time_s;
}

std::size_t TrainingFixes(const Recording& recording, const HeldOutOptions& held_out) {
  return static_cast<std::size_t>((1.0 - held_out.share) *
                                  static_cast<double>(recording.gnss.size()));
}

}  // namespace

double HeldOutSpan(const Recording& recording, const HeldOutOptions& held_out) {
  if (recording.gnss.empty()) return 0.0;
  const std::size_t training_fixes = std::max<std::size_t>(TrainingFixes(recording, held_out), 1);
  return recording.gnss.back().time_s - recording.gnss[training_fixes - 1].time_s;
}

Result<HeldOutScore> ScoreOnHeldOutPart(const Recording& recording, const Vehicle& vehicle,
                                        const IdentifyOptions& options,
                                        const HeldOutOptions& held_out) {
  constexpr const char* kSubject = "held-out score";
  constexpr const char* kAdvice = "score the model on another recording";
  const std::size_t fixes = recording.gnss.size();
  if (fixes > held_out.most_fixes) {
    return Refuse(kSubject, "the recording is long, and the score costs a second identification",
                  kAdvice);
  }
  const std::size_t training_fixes = TrainingFixes(recording, held_out);
  if (training_fixes < 2 || training_fixes + 2 > fixes) {
    return Refuse(kSubject, "the recording is too short to hold out a part of it", kAdvice);
  }
  constexpr double kForever = std::numeric_limits<double>::infinity();
  const double split_s = recording.gnss[training_fixes - 1].time_s;
  const Recording training = Between(recording, -kForever, split_s);
  const Recording rest = Between(recording, split_s, kForever);

  const auto model = Identify(training, vehicle, WithoutBounds(options, training));
  if (!model) return tl::unexpected(model.error());
  PrepareOptions prepare = options.prepare;
  prepare.sampling_period_s = model->sampling_period_s;
  const auto dataset = Prepare(rest, vehicle, prepare);
  if (!dataset) return tl::unexpected(dataset.error());
  const auto metrics = Validate(*dataset, *model, {{held_out.horizon_s}});
  if (!metrics) return tl::unexpected(metrics.error());
  if (metrics->free_run.front().windows == 0) {
    return Refuse(kSubject, "no free run fits into the part that is held out", kAdvice);
  }
  return HeldOutScore{Span(training), Span(rest), *metrics};
}

Result<HeldOutScore> ScoreOnHeldOutPart(const Recording& recording, const Vehicle& vehicle,
                                        const Identification& identification,
                                        const IdentifyOptions& options,
                                        const HeldOutOptions& held_out) {
  IdentifyOptions alike = options;
  alike.regression.structure = identification.structure;
  alike.estimator = identification.estimator;
  alike.prepare.sampling_period_s = identification.sampling_period_s;
  return ScoreOnHeldOutPart(recording, vehicle, alike, held_out);
}

}  // namespace telltale
