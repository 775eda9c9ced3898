#include "telltale/idl/codec/json/provenance.hpp"

#include <array>
#include <string>

#include "telltale/idl/codec/json/model_change.hpp"
#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

void Write(const RejectCounts& rejected, proto::WindowSummary& message) {
  for (const Channel channel : kChannels) {
    for (const RejectReason reason : kRejectReasons) {
      const std::uint64_t count = rejected.Of(channel, reason);
      if (count == 0) continue;
      proto::RejectCount& entry = *message.add_rejected();
      entry.set_channel(std::string(Name(channel)));
      entry.set_reason(std::string(Name(reason)));
      entry.set_count(Saturated(count));
    }
  }
}

void Write(const RecordingIdentity& recording, proto::RecordingIdentity& message) {
  message.set_name(recording.name);
  message.set_start_s(recording.start_s);
  message.set_end_s(recording.end_s);
  message.set_fixes(Saturated(recording.fixes));
  for (const std::uint32_t mark : recording.marks) message.add_marks(mark);
}

RecordingIdentity ReadRecordingIdentity(FieldReader reader,
                                        const proto::RecordingIdentity& message) {
  return {message.name(),
          reader.Number("start_s", kFinite),
          reader.Number("end_s", kFinite),
          message.fixes(),
          {message.marks().begin(), message.marks().end()}};
}

template <class Value, std::size_t N>
Value ReadNamed(FieldReader& reader, const char* field, const std::string& name,
                const std::array<Value, N>& values) {
  std::string allowed;
  for (const Value value : values) {
    if (Name(value) == name) return value;
    allowed += (allowed.empty() ? "one of " : ", ") + std::string(Name(value));
  }
  reader.Fail(field, Quoted(name), allowed);
  return values.front();
}

}  // namespace

proto::WindowSummary ToProto(const WindowSummary& window) {
  proto::WindowSummary message;
  message.set_start_s(window.start_s);
  message.set_end_s(window.end_s);
  message.set_samples(Saturated(window.samples));
  message.set_segments(Saturated(window.segments));
  message.set_slices(Saturated(window.slices));
  Write(window.rejected, message);
  return message;
}

proto::Refusal ToProto(const Refusal& refusal) {
  proto::Refusal message;
  message.set_subject(refusal.subject);
  message.set_reason(refusal.reason);
  message.set_advice(refusal.advice);
  return message;
}

proto::Provenance ToProto(const Provenance& provenance) {
  proto::Provenance message;
  message.set_preset(provenance.preset);
  message.set_bounds_basis(provenance.bounds_basis);
  message.set_bootstrap_replicates(Saturated(provenance.bootstrap_replicates));
  message.set_bootstrap_failures(Saturated(provenance.bootstrap_failures));
  message.set_seed(provenance.seed);
  message.set_software_version(provenance.software_version);
  message.set_parametric_replicates(Saturated(provenance.parametric_replicates));
  message.set_parametric_replicate_failures(Saturated(provenance.parametric_replicate_failures));
  message.set_structure_choice(provenance.structure_choice);
  message.set_estimator_choice(provenance.estimator_choice);
  message.set_misspecification(provenance.misspecification);
  message.set_clusters(Saturated(provenance.clusters));
  if (provenance.change) *message.mutable_change() = ToProto(*provenance.change);
  for (const RecordingIdentity& recording : provenance.recordings) {
    Write(recording, *message.add_recordings());
  }
  return message;
}

WindowSummary ReadWindow(FieldReader reader, const proto::WindowSummary& message) {
  WindowSummary window;
  window.start_s = reader.Number("start_s", kFinite);
  window.end_s = reader.Number("end_s", kFinite);
  if (window.start_s > window.end_s) {
    reader.Fail("start_s", NumberText(window.start_s),
                "not after endS = " + NumberText(window.end_s));
  }
  window.samples = message.samples();
  window.segments = message.segments();
  window.slices = message.slices();
  for (int i = 0; i < message.rejected_size(); ++i) {
    FieldReader item = reader.Item("rejected", i);
    const proto::RejectCount& entry = message.rejected(i);
    const Channel channel = ReadNamed(item, "channel", entry.channel(), kChannels);
    const RejectReason reason = ReadNamed(item, "reason", entry.reason(), kRejectReasons);
    window.rejected.Count(channel, reason, entry.count());
  }
  return window;
}

Refusal ReadRefusal(const FieldReader&, const proto::Refusal& message) {
  return {message.subject(), message.reason(), message.advice()};
}

Provenance ReadProvenance(FieldReader reader, const proto::Provenance& message) {
  Provenance provenance;
  provenance.preset = message.preset();
  provenance.bounds_basis = message.bounds_basis();
  provenance.bootstrap_replicates = message.bootstrap_replicates();
  provenance.bootstrap_failures = message.bootstrap_failures();
  provenance.seed = message.seed();
  provenance.software_version = message.software_version();
  provenance.parametric_replicates = message.parametric_replicates();
  provenance.parametric_replicate_failures = message.parametric_replicate_failures();
  provenance.structure_choice = message.structure_choice();
  provenance.estimator_choice = message.estimator_choice();
  provenance.misspecification = reader.Number("misspecification", kNotNegative, 0.0);
  provenance.clusters = message.clusters();
  if (message.has_change()) {
    provenance.change = ReadModelChange(reader.Optional("change"), message.change());
  }
  provenance.recordings =
      ReadAll(reader, "recordings", message.recordings(), ReadRecordingIdentity);
  return provenance;
}

}  // namespace telltale
