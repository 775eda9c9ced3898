#include "inputs/diagnosis_inputs.hpp"

#include "telltale/client/cli/input_options.hpp"
#include "telltale/client/workbench/errors.hpp"
#include "telltale/client/workbench/files.hpp"
#include "telltale/client/workbench/recorded_log.hpp"
#include "telltale/core/data/preparation.hpp"

namespace blind {

using telltale::OrThrow;

void DiagnosisInputFiles::AddTo(CLI::App& app) {
  app.add_option("--log", log, "the recording")->type_name("DIR")->required();
  app.add_option("--vehicle", vehicle, "the boat")->type_name("FILE")->required();
  app.add_option("--model", model, "the model that knows nothing of the recording")
      ->type_name("FILE")
      ->required();
  app.add_option("--reference-log", references, "a recording of when all was well, several times")
      ->type_name("DIR")
      ->required();
}

DiagnosisInputs DiagnosisInputFiles::Load() const {
  const telltale::Vehicle boat = telltale::LoadVehicle(vehicle);
  const telltale::Identification identification = telltale::LoadModel(model);
  telltale::PrepareOptions options = telltale::PrepareOptions::Robust();
  options.sampling_period_s = identification.sampling_period_s;
  const auto prepared = [&](const std::filesystem::path& folder) {
    return OrThrow(
        telltale::Prepare(telltale::LoadAdmitted(folder, {}, telltale::PrintNote), boat, options));
  };
  DiagnosisInputs inputs{.model = OrThrow(telltale::UncertainModelOf(identification)),
                         .recording = prepared(log),
                         .references = {}};
  for (const auto& reference : references) inputs.references.push_back(prepared(reference));
  return inputs;
}

}  // namespace blind
