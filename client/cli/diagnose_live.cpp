#include "telltale/client/cli/diagnose_live.hpp"

#include <algorithm>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/table.hpp"
#include "telltale/client/fleet/diagnosis_client.hpp"

namespace telltale {
namespace {

DiagnoseRequest DiagnoseRequestOf(const std::string& vehicle_id,
                                  const DiagnoseArguments& arguments) {
  DiagnoseRequest request;
  request.correlation_id = NewCorrelationId();
  request.vehicle_id = vehicle_id;
  request.refit = arguments.choices.refit;
  request.without = arguments.choices.without;
  request.seed = arguments.choices.seed;
  return request;
}

DiagnoseResult AskForDiagnosis(const DiagnoseRequest& request, const LiveOptions& live) {
  const Participant participant(live.domain);
  DiagnosisClient client(participant);
  ProgressLine line;
  line.Update("asking the daemon", 0.0);
  return client.Diagnose(request, live.Timing(), [&line](const DiagnoseProgress& progress) {
    line.Update(progress.stage, progress.fraction);
  });
}

}  // namespace

void DiagnoseLive(const std::string& vehicle_id, const DiagnoseArguments& arguments,
                  const LiveOptions& live) {
  const DiagnoseResult result = AskForDiagnosis(DiagnoseRequestOf(vehicle_id, arguments), live);
  RequirePublished(result, vehicle_id, live);
  const PublishedDiagnosis& published = *result.reply->diagnosis;
  arguments.Write(published.diagnosis, result.reply->augmented, SourcesOf(published),
                  "Held against revision " + std::to_string(published.model_revision) + " of " +
                      vehicle_id + ".");
}

}  // namespace telltale
