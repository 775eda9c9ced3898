#include "telltale/idl/codec/json/gap.hpp"

#include <algorithm>

#include "telltale/idl/codec/json/proto_values.hpp"

namespace telltale {
namespace {

using Region = proto::GapCell;

template <class Message>
void Write(const GapSize& size, Message& message) {
  message.set_before(size.before);
  message.set_after(size.after);
  message.set_noise_floor(size.noise_floor);
  message.set_floor_limit(size.floor_limit);
}

Interval ReadClosureInterval(FieldReader reader) {
  return {reader.Number("level", kShare), reader.Number("lower", kNotNan),
          reader.Number("upper", kNotNan)};
}

GapSize ReadSize(FieldReader& reader) {
  return {reader.Number("before", kNotNegative), reader.Number("after", kNotNegative),
          reader.Number("noise_floor", kNotNegative), reader.Number("floor_limit", kNotNegative)};
}

}  // namespace

proto::GapCell::PropellerRegion RegionOf(const std::optional<PropellerRegion>& region) {
  constexpr int kFirst = static_cast<int>(Region::FF);
  return region ? static_cast<Region::PropellerRegion>(kFirst + static_cast<int>(*region))
                : Region::ALL;
}

proto::Gap ToProto(const Gap& gap) {
  proto::Gap message;
  message.set_horizon_s(gap.horizon_s);
  message.set_windows(Saturated(gap.windows));
  Write(gap.all, message);
  WriteClosure(gap.excess_explained, message);
  for (const Equation equation : kEquations) {
    proto::ChannelGap& channel = *message.add_channels();
    channel.set_channel(EnumCast<proto::Equation>(equation));
    Write(gap.channels[IndexOf(equation)], channel);
    WriteClosure(gap.channel_excess_explained[IndexOf(equation)], channel);
  }
  return message;
}

proto::GapCell ToProto(const GapCell& cell) {
  proto::GapCell message;
  message.set_channel(EnumCast<proto::Equation>(cell.channel));
  message.set_propeller_region(RegionOf(cell.region));
  message.set_bin(cell.bin);
  message.set_excess_share(cell.excess_share);
  message.set_p_value(cell.p_value);
  message.set_kind(EnumCast<proto::GapCell::Kind>(cell.kind));
  message.set_mean(cell.mean);
  message.set_windows(Saturated(cell.windows));
  return message;
}

std::optional<PropellerRegion> ReadRegion(FieldReader& reader,
                                          proto::GapCell::PropellerRegion value) {
  const int number = ReadEnum<int>(reader, "propeller_region", value);
  if (number == static_cast<int>(Region::ALL)) return std::nullopt;
  return static_cast<PropellerRegion>(std::max(number - static_cast<int>(Region::FF), 0));
}

std::optional<ExcessExplained> ReadExcessExplained(FieldReader& reader) {
  if (!reader.Has("closure")) return std::nullopt;
  return ExcessExplained{reader.Number("closure", kNotNan),
                         ReadClosureInterval(reader.Required("closure_interval"))};
}

Gap ReadGap(FieldReader reader, const proto::Gap& message) {
  Gap gap;
  gap.horizon_s = reader.Number("horizon_s", {0.0, kNotNegative.high, true});
  gap.windows = message.windows();
  gap.all = ReadSize(reader);
  gap.excess_explained = ReadExcessExplained(reader);
  for (int i = 0; i < message.channels_size(); ++i) {
    FieldReader item = reader.Item("channels", i);
    const auto channel = ReadEnum<Equation>(item, "channel", message.channels(i).channel());
    if (channel == Equation::kUnknown) continue;
    gap.channels[IndexOf(channel)] = ReadSize(item);
    gap.channel_excess_explained[IndexOf(channel)] = ReadExcessExplained(item);
  }
  return gap;
}

GapCell ReadGapCell(FieldReader reader, const proto::GapCell& message) {
  GapCell cell;
  cell.channel = ReadEnum<Equation>(reader, "channel", message.channel());
  cell.region = ReadRegion(reader, message.propeller_region());
  cell.bin = message.bin();
  cell.excess_share = reader.Number("excess_share", kNotNan);
  cell.p_value = reader.Number("p_value", kShare);
  cell.kind = ReadEnum<GapKind>(reader, "kind", message.kind());
  cell.mean = reader.Number("mean", kNotNan);
  cell.windows = message.windows();
  return cell;
}

}  // namespace telltale
