#include "telltale/core/validation/held_out_score.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>

#include "telltale/core/data/preparation.hpp"
#include "telltale/core/data/recording_parts.hpp"

namespace telltale {
namespace {

/// Between, with the recordings that begin there.
Recording PartOf(const Recording& recording, double from_s, double to_s) {
  Recording part = Between(recording, from_s, to_s);
  std::copy_if(recording.starts_s.begin(), recording.starts_s.end(),
               std::back_inserter(part.starts_s),
               [&](double start_s) { return start_s > from_s && start_s <= to_s; });
  return part;
}

IdentifyOptions WithoutBounds(IdentifyOptions options, const Recording& training) {
  options.bootstrap_replicates = 0;
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

}  // namespace

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
  const auto training_fixes =
      static_cast<std::size_t>((1.0 - held_out.share) * static_cast<double>(fixes));
  if (training_fixes < 2 || training_fixes + 2 > fixes) {
    return Refuse(kSubject, "the recording is too short to hold out a part of it", kAdvice);
  }
  constexpr double kForever = std::numeric_limits<double>::infinity();
  const double split_s = recording.gnss[training_fixes - 1].time_s;
  const Recording training = PartOf(recording, -kForever, split_s);
  const Recording rest = PartOf(recording, split_s, kForever);

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
  alike.estimator = identification.estimator;
  alike.prepare.sampling_period_s = identification.sampling_period_s;
  return ScoreOnHeldOutPart(recording, vehicle, alike, held_out);
}

}  // namespace telltale
