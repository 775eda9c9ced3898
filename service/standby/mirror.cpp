#include "telltale/service/standby/mirror.hpp"

#include <cmath>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/idl/codec/wire/diagnosis.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/service/models/free_run_error.hpp"

namespace telltale {
namespace {

// Between the end of a window and the end of the identification that it goes into.
constexpr double kJustMadeWithinS = 30.0;

template <class Message, class Keep>
void KeepOrLog(const Decoded<Message>& message, const char* what, Keep keep) {
  if (!message) {
    spdlog::warn("another daemon's {} cannot be read: {}", what, message.error().Message());
    return;
  }
  try {
    keep(*message);
  } catch (const std::exception& error) {
    spdlog::error("another daemon's {} is not kept: {}", what, error.what());
  }
}

}  // namespace

Mirror::Mirror(const Participant& participant, WaitSet& wait_set, const Role& role,
               const Into& into)
    : wait_set_(wait_set),
      role_(role),
      into_(into),
      model_reader_(participant, FromOthers(ModelQos())),
      diagnosis_reader_(participant, FromOthers(DiagnosisQos())) {
  wait_set_.Attach(model_reader_, [this] {
    model_reader_.Take([this](const telltale_wire_Model& wire) { Take(wire); });
  });
  wait_set_.Attach(diagnosis_reader_, [this] {
    diagnosis_reader_.Take([this](const telltale_wire_Diagnosis& wire) { Take(wire); });
  });
}

Mirror::~Mirror() {
  wait_set_.Detach(model_reader_);
  wait_set_.Detach(diagnosis_reader_);
}

void Mirror::Take(const telltale_wire_Model& wire) {
  KeepOrLog(Decode(wire), "model", [this](const PublishedModel& model) { Keep({model, {}}); });
}

void Mirror::Take(const telltale_wire_Diagnosis& wire) {
  if (role_.Serves()) return;
  KeepOrLog(Decode(wire), "diagnosis",
            [this](const PublishedDiagnosis& diagnosis) { into_.diagnoses.Learn(diagnosis); });
}

void Mirror::Keep(StoredModel model) {
  const Identification& identification = model.model.identification;
  VehicleWindow* const window = into_.fleet.Find(identification.vehicle_id);
  const bool just_made =
      window != nullptr &&
      std::abs(window->State().end_s - identification.window.end_s) < kJustMadeWithinS;
  if (!just_made) return into_.models.Learn(model);
  Recording recording = window->Snapshot();
  model.reference_error = MeasureFreeRunError(recording, window->vehicle(), identification);
  into_.models.Learn(model);
  into_.baselines.Keep(identification.vehicle_id, model.model.revision, std::move(recording));
}

}  // namespace telltale
