#include "telltale/client/bridge/live_ros_vehicle.hpp"

#include <utility>

namespace telltale {

LiveRosVehicle::LiveRosVehicle(const SourceOptions& options, Publish publish, const Report& report,
                               ChannelChoice choice)
    : choice_(std::move(choice)), publish_(std::move(publish)), mapping_(options.mapping) {
  SampleSink sink{.fix = [this](const GnssFix& fix) { Deliver(Channel::kGnss, fix); },
                  .heading = [this](const HeadingSample& one) { Deliver(Channel::kHeading, one); },
                  .command =
                      [this](Side side, const SideCommand& command) {
                        made_sample_ = true;
                        joiner_.Take(side, command, [this](const ThrusterSample& sample) {
                          Deliver(Channel::kThrusters, sample);
                        });
                      }};
  if (mapping_) {
    mapped_.emplace(*mapping_, std::move(sink));
  } else {
    by_rules_.emplace(
        options, std::move(sink), [this](RosReject reason) { Count(reason); }, report);
  }
}

void LiveRosVehicle::Take(std::string_view topic, std::string_view type,
                          std::span<const std::uint8_t> bytes, double arrival_s) {
  if (mapped_) {
    TakeMapped(topic, type, bytes, arrival_s);
  } else {
    by_rules_->Take(topic, type, bytes, arrival_s);
  }
}

void LiveRosVehicle::TakeMapped(std::string_view topic, std::string_view type,
                                std::span<const std::uint8_t> bytes, double arrival_s) {
  const RosMessageType* const known = types_.Find(type, "", CdrReader::Encoding::kCdr);
  if (known == nullptr) return Count(RosReject::kUnreadable);
  made_sample_ = false;
  mapped_->Take(topic, arrival_s, RosFields(*known, bytes, CdrReader::Encoding::kCdr));
  if (!made_sample_) Count(RosReject::kNotMapped);
}

void LiveRosVehicle::Deliver(Channel channel, const RawSample& sample) {
  made_sample_ = true;
  if (!Takes(choice_, channel)) return;
  ++published_[static_cast<std::size_t>(channel)];
  publish_(sample);
}

bool NamesRosTopic(const SourceOptions& options, std::string_view topic, std::string_view type) {
  if (options.mapping) return MappedSamples(*options.mapping, {}).Names(topic);
  return LiveRosTopics::Names(topic, type);
}

}  // namespace telltale
