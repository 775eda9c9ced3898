#include "telltale/idl/codec/json/missing_force.hpp"

#include <algorithm>
#include <string>

#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

void Write(const ForceMean& force, proto::MissingForce::Mean& message) {
  message.set_mean(force.mean);
  message.set_half_width(force.half_width);
}

void Write(const ForceBin& bin, proto::MissingForce::Bin& message) {
  message.set_low(bin.low);
  message.set_high(bin.high);
  message.set_rows(Saturated(bin.rows));
  Write(bin.force[0], *message.mutable_surge());
  Write(bin.force[1], *message.mutable_sway());
  Write(bin.force[2], *message.mutable_yaw());
}

void Write(const ForceProfile& profile, proto::MissingForce::Profile& message) {
  message.set_variable(EnumCast<proto::MissingForce::Variable>(profile.variable));
  for (const ForceBin& bin : profile.bins) Write(bin, *message.add_bins());
  message.mutable_share()->Add(profile.share.begin(), profile.share.end());
}

ForceMean ReadMean(FieldReader reader) {
  return {reader.Number("mean", kNotNan), reader.Number("half_width", kNotNegative)};
}

ForceBin ReadBin(FieldReader reader, const proto::MissingForce::Bin& message) {
  ForceBin bin;
  bin.low = reader.Number("low", kNotNan);
  bin.high = reader.Number("high", kNotNan);
  bin.rows = message.rows();
  bin.force = {ReadMean(reader.Required("surge")), ReadMean(reader.Required("sway")),
               ReadMean(reader.Required("yaw"))};
  return bin;
}

bool HasThree(FieldReader& reader, const char* field, int count) {
  if (count == 3) return true;
  reader.Fail(field, std::to_string(count) + " entries", "3: surge, sway and yaw");
  return false;
}

ForceProfile ReadProfile(FieldReader reader, const proto::MissingForce::Profile& message) {
  ForceProfile profile;
  profile.variable = ReadEnum<ForceVariable>(reader, "variable", message.variable());
  profile.bins = ReadAll(reader, "bins", message.bins(), ReadBin);
  if (HasThree(reader, "share", message.share_size())) {
    std::copy(message.share().begin(), message.share().end(), profile.share.begin());
  }
  return profile;
}

}  // namespace

proto::MissingForce ToProto(const MissingForce& missing) {
  proto::MissingForce message;
  message.set_mass_kg(missing.mass_kg);
  message.set_sentence(missing.sentence);
  for (std::size_t i = 0; i < missing.mean.size(); ++i) {
    proto::MissingForce::Component& component = *message.add_components();
    Write(missing.mean[i], *component.mutable_mean());
    component.set_constant_share(missing.constant_share[i]);
    component.set_scatter(missing.scatter[i]);
    component.set_excess(missing.excess[i]);
  }
  for (const ForceProfile& profile : missing.over) Write(profile, *message.add_over());
  return message;
}

MissingForce ReadMissingForce(FieldReader reader, const proto::MissingForce& message) {
  MissingForce missing;
  missing.mass_kg = reader.Number("mass_kg", kNotNegative);
  missing.sentence = message.sentence();
  if (HasThree(reader, "components", message.components_size())) {
    for (std::size_t i = 0; i < missing.mean.size(); ++i) {
      FieldReader component = reader.Item("components", static_cast<int>(i));
      missing.mean[i] = ReadMean(component.Required("mean"));
      missing.constant_share[i] = component.Number("constant_share", kShare);
      missing.scatter[i] = component.Number("scatter", kNotNegative);
      missing.excess[i] = component.Number("excess", kNotNan);
    }
  }
  missing.over = ReadAll(reader, "over", message.over(), ReadProfile);
  return missing;
}

}  // namespace telltale
