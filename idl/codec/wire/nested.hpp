#pragma once

#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/idl/codec/messages/model.hpp"
#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/idl/dds/telltale.h"

/// The structs that several messages hold. Private to idl/codec/wire. A reader throws Malformed.
namespace telltale::wire {

void FillRefusal(telltale_wire_Refusal& wire, const Refusal& refusal);
Refusal ReadRefusal(const std::string& field, const telltale_wire_Refusal& wire);

void FillRejectCount(telltale_wire_RejectCount& wire, const RejectEntry& entry);
RejectEntry ReadRejectEntry(const std::string& field, const telltale_wire_RejectCount& wire);

DeadZone ReadDeadZone(double forward, double reverse);

void FillModel(telltale_wire_Model& wire, const PublishedModel& model);
PublishedModel ReadModel(const telltale_wire_Model& wire);

void FillDiagnosis(telltale_wire_Diagnosis& wire, const PublishedDiagnosis& published);
PublishedDiagnosis ReadDiagnosis(const telltale_wire_Diagnosis& wire);

/// Excitation, advice and coverage check of a model, once its other fields are in place.
void FillIdentifiability(telltale_wire_Model& wire, const Identification& identification);
void ReadIdentifiability(const telltale_wire_Model& wire, Identification& identification);

}  // namespace telltale::wire
