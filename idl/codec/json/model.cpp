#include "telltale/idl/codec/json/model.hpp"

#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/coverage_check.hpp"
#include "telltale/idl/codec/json/estimates.hpp"
#include "telltale/idl/codec/json/excitation.hpp"
#include "telltale/idl/codec/json/json_message.hpp"
#include "telltale/idl/codec/json/manoeuvre_advice.hpp"
#include "telltale/idl/codec/json/model_version.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"
#include "telltale/idl/codec/json/provenance.hpp"
#include "telltale/idl/codec/model_rules.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale {
namespace {

Identification ReadModel(FieldReader reader, const proto::Model& model) {
  Identification identification;
  identification.vehicle_id = model.vehicle_id();
  if (!IsVehicleId(identification.vehicle_id)) {
    reader.Fail("vehicle_id", Quoted(identification.vehicle_id), std::string(kVehicleIdAllowed));
  }
  identification.structure = ReadEnum<Structure>(reader, "structure", model.structure());
  identification.parameterization =
      ReadEnum<Parameterization>(reader, "parameterization", model.parameterization());
  identification.estimator = ReadEnum<Estimator>(reader, "estimator", model.estimator());
  identification.sampling_period_s = reader.Number("sampling_period_s", kSamplingPeriodS);
  ReadEstimates(reader, model, identification);
  identification.window = ReadWindow(reader.Optional("window"), model.window());
  identification.refusals = ReadAll(reader, "refusals", model.refusals(), ReadRefusal);
  identification.provenance = ReadProvenance(reader.Optional("provenance"), model.provenance());
  return identification;
}

/// Requires coefficients that have passed ModelFault().
void ReadIdentifiability(FieldReader& reader, const proto::Model& model,
                         Identification& identification) {
  identification.excitation =
      ReadAll(reader, "excitation", model.excitation(), [&](FieldReader item, const auto& message) {
        return ReadExcitation(item, message, identification.parameterization);
      });
  identification.advice = ReadAll(reader, "advice", model.advice(), ReadManoeuvreAdvice);
  if (model.has_coverage_check()) {
    identification.coverage_check =
        ReadCoverageCheck(reader.Optional("coverage_check"), model.coverage_check(),
                          identification.coefficients.size());
  }
}

}  // namespace

proto::Model ToProto(const Identification& identification) {
  proto::Model model;
  model.set_vehicle_id(identification.vehicle_id);
  model.set_structure(EnumCast<proto::Structure>(identification.structure));
  model.set_parameterization(EnumCast<proto::Parameterization>(identification.parameterization));
  model.set_estimator(EnumCast<proto::Estimator>(identification.estimator));
  model.set_sampling_period_s(identification.sampling_period_s);
  WriteEstimates(identification, model);
  *model.mutable_window() = ToProto(identification.window);
  for (const Refusal& refusal : identification.refusals) *model.add_refusals() = ToProto(refusal);
  *model.mutable_provenance() = ToProto(identification.provenance);
  for (const ExcitationSummary& summary : identification.excitation) {
    *model.add_excitation() = ToProto(summary, identification.parameterization);
  }
  for (const ManoeuvreAdvice& advice : identification.advice) *model.add_advice() = ToProto(advice);
  if (const auto& coverage_check = identification.coverage_check) {
    *model.mutable_coverage_check() = ToProto(*coverage_check, identification.coefficients);
  }
  return model;
}

Decoded<Identification> IdentificationOf(const proto::Model& model, const std::string& file) {
  const FieldSource source{file, FieldSource::Names::kJson, nullptr};
  std::optional<CodecError> fault;
  FieldReader reader(model, source, fault);
  Identification identification = ReadModel(reader, model);
  if (!fault) {
    fault = ModelFault(identification);
    if (fault) fault->where = file;
  }
  if (!fault) ReadIdentifiability(reader, model, identification);
  if (fault) return tl::unexpected(*fault);
  return identification;
}

std::string PrintModelJson(const Identification& identification) {
  return PrintJsonMessage(ToProto(identification));
}

Decoded<Identification> ParseModelJson(std::string_view text, const std::string& file) {
  proto::Model model;
  const auto fault = ParseJsonMessage(text, file, model);
  // The names of fields differ between versions: the version is the cause of an unknown field.
  if (auto outdated = OutdatedModel(text, file)) return tl::unexpected(*std::move(outdated));
  if (fault) return tl::unexpected(*fault);
  return IdentificationOf(model, file);
}

}  // namespace telltale
