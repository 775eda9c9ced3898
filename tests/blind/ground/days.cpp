#include "ground/days.hpp"

#include "telltale/client/cli/inputs.hpp"
#include "telltale/client/cli/outcome.hpp"
#include "telltale/core/data/preparation.hpp"

namespace blind {

using telltale::OrThrow;

void DayFiles::AddTo(CLI::App& app) {
  app.add_option("--log", log, "the recording")->type_name("DIR")->required();
  app.add_option("--vehicle", vehicle, "the boat")->type_name("FILE")->required();
  app.add_option("--model", model, "the model that knows nothing of the recording")
      ->type_name("FILE")
      ->required();
  app.add_option("--reference-log", references, "a recording of when all was well, several times")
      ->type_name("DIR")
      ->required();
}

Days DayFiles::Load() const {
  const telltale::Vehicle boat = telltale::LoadVehicle(vehicle);
  const telltale::Identification identification = telltale::LoadModel(model);
  telltale::PrepareOptions options = telltale::PrepareOptions::Robust();
  options.sampling_period_s = identification.sampling_period_s;
  const auto prepared = [&](const std::filesystem::path& folder) {
    return OrThrow(telltale::Prepare(telltale::LoadAdmitted(folder, {}), boat, options));
  };
  Days days{.model = OrThrow(telltale::UncertainModelOf(identification)),
            .recording = prepared(log),
            .references = {}};
  for (const auto& reference : references) days.references.push_back(prepared(reference));
  return days;
}

}  // namespace blind
