#include "telltale/idl/codec/wire/diagnosis.hpp"

#include <utility>

#include "telltale/idl/codec/json/report.hpp"
#include "telltale/idl/codec/wire/nested.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {
namespace wire {

void FillDiagnosis(telltale_wire_Diagnosis& wire, const PublishedDiagnosis& published) {
  PutIdentifier(wire.vehicle_id, published.diagnosis.vehicle_id);
  wire.model_revision = published.model_revision;
  wire.published_unix_s = published.published_unix_s;
  Put(wire.verdict, Name(published.diagnosis.verdict));
  Put(wire.sentence, published.diagnosis.sentence);
  Put(wire.report, PrintReportJson(published.diagnosis));
}

PublishedDiagnosis ReadDiagnosis(const telltale_wire_Diagnosis& wire) {
  PublishedDiagnosis published;
  auto diagnosis = ParseReportJson(View(wire.report));
  if (!diagnosis) throw Malformed{std::move(diagnosis).error()};
  published.diagnosis = *std::move(diagnosis);
  if (ReadIdentifier("vehicle_id", wire.vehicle_id) != published.diagnosis.vehicle_id) {
    Reject("vehicle_id", TextOf(wire.vehicle_id),
           "the report's, " + published.diagnosis.vehicle_id);
  }
  published.model_revision = wire.model_revision;
  published.published_unix_s =
      ReadWithin("published_unix_s", wire.published_unix_s, kFiniteNotNegative);
  return published;
}

}  // namespace wire

WireSample<telltale_wire_Diagnosis> Encode(const PublishedDiagnosis& diagnosis) {
  WireSample<telltale_wire_Diagnosis> sample;
  wire::FillDiagnosis(*sample, diagnosis);
  return sample;
}

Decoded<PublishedDiagnosis> Decode(const telltale_wire_Diagnosis& wire) {
  return wire::Guarded([&] { return wire::ReadDiagnosis(wire); });
}

}  // namespace telltale
