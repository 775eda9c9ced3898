#include "telltale/client/cli/identify_live.hpp"

#include <iostream>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/discrete_table.hpp"
#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/cli/model_table.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/promotion_text.hpp"
#include "telltale/client/fleet/identification_client.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/presets.hpp"
#include "telltale/idl/codec/json/published.hpp"

namespace telltale {
namespace {

constexpr std::uint32_t kReplicatesPerTimeout = 10;

IdentifyRequest RequestOf(const std::string& vehicle_id, const IdentifyArguments& arguments) {
  const IdentifyChoices& choices = arguments.choices;
  const IdentifyOptions options = choices.Options(1);
  if (choices.structure == "auto") {
    throw UsageError(
        "--structure auto belongs to --log: with --vehicle-id the daemon's configuration lets the "
        "data choose, identification { structure: \"auto\" }; leave it out");
  }
  if (choices.sampling_period_s || choices.interval_level || choices.threads ||
      choices.parametric_replicates) {
    throw UsageError(
        "--sampling-period, --level, --threads and --replicates are set by the daemon; leave them "
        "out with --vehicle-id");
  }
  IdentifyRequest request;
  request.correlation_id = NewCorrelationId();
  request.vehicle_id = vehicle_id;
  if (choices.structure) request.structure = options.regression.structure;
  if (choices.ChooseDeadZone()) {
    request.dead_zone_source = options.dead_zone_source;
    request.dead_zone = options.regression.dead_zone;
  }
  if (choices.parameterization) request.parameterization = options.regression.parameterization;
  request.estimator = options.estimator.value_or(Estimator::kUnknown);
  if (choices.preset) request.preset = PresetNamed(*choices.preset);
  request.bootstrap_replicates = choices.bootstrap_replicates;
  if (choices.bootstrap_kind) request.resampling = options.resampling;
  if (choices.interval) request.interval_method = options.interval_method;
  request.seed = choices.seed;
  request.include_reverse = choices.include_rr;
  request.coverage_check_replicates = choices.coverage_check_replicates;
  if (choices.recording_bias) request.recording_bias = options.regression.recording_bias;
  return request;
}

IdentifyResult Ask(const IdentifyRequest& request, const LiveOptions& live) {
  const Participant participant(live.domain);
  IdentificationClient client(participant);
  RequestTiming timing = live.Timing();
  // A replicate costs as much as the identification; the daemon runs several at a time.
  timing.reply *= (1 + request.coverage_check_replicates / kReplicatesPerTimeout);
  ProgressLine line;
  line.Update("asking the daemon", 0.0);
  return client.Identify(request, timing, [&line](const IdentifyProgress& progress) {
    line.Update(progress.stage, progress.fraction);
  });
}

}  // namespace

void IdentifyLive(const std::string& vehicle_id, const IdentifyArguments& arguments,
                  const LiveOptions& live) {
  const IdentifyResult result = Ask(RequestOf(vehicle_id, arguments), live);
  RequirePublished(result, vehicle_id, live);
  const PublishedModel& model = *result.reply->model;
  arguments.output.Write(PrintModelJson(model), [&] {
    return vehicle_id + ", revision " + std::to_string(model.revision) + "\n" +
           PromotionText(model.promotion) + '\n' + ModelTable(model.identification) +
           (arguments.discrete ? '\n' + DiscreteTable(model.identification) : "");
  });
  if (model.promotion.verdict == PromotionVerdict::kError) {
    throw RefusedError({"revision " + std::to_string(model.revision),
                        "it is published with verdict ERROR: " + model.promotion.reason,
                        "record more varied manoeuvres, or go back to an earlier model: telltale "
                        "rollback --vehicle-id " +
                            vehicle_id});
  }
}

}  // namespace telltale
