#include "telltale/service/windows/window_chunk.hpp"

#include "telltale/service/storage/packed_blob.hpp"

namespace telltale {

proto::WindowChunk ToProto(const Recording& recording) {
  proto::WindowChunk chunk;
  for (const GnssFix& fix : recording.gnss) {
    chunk.mutable_gnss()->add_time_s(fix.time_s);
    chunk.mutable_gnss()->add_latitude_deg(fix.latitude_deg);
    chunk.mutable_gnss()->add_longitude_deg(fix.longitude_deg);
  }
  for (const HeadingSample& sample : recording.heading) {
    chunk.mutable_heading()->add_time_s(sample.time_s);
    chunk.mutable_heading()->add_heading_deg(sample.heading_deg);
  }
  for (const ThrusterSample& sample : recording.thrusters) {
    chunk.mutable_thrusters()->add_time_s(sample.time_s);
    chunk.mutable_thrusters()->add_port_us(sample.port_us);
    chunk.mutable_thrusters()->add_starboard_us(sample.starboard_us);
  }
  return chunk;
}

std::optional<Recording> RecordingOf(const proto::WindowChunk& chunk) {
  const auto& gnss = chunk.gnss();
  const auto& heading = chunk.heading();
  const auto& thrusters = chunk.thrusters();
  const bool complete = gnss.latitude_deg_size() == gnss.time_s_size() &&
                        gnss.longitude_deg_size() == gnss.time_s_size() &&
                        heading.heading_deg_size() == heading.time_s_size() &&
                        thrusters.port_us_size() == thrusters.time_s_size() &&
                        thrusters.starboard_us_size() == thrusters.time_s_size();
  if (!complete) return std::nullopt;
  Recording recording;
  for (int i = 0; i < gnss.time_s_size(); ++i) {
    recording.gnss.push_back({gnss.time_s(i), gnss.latitude_deg(i), gnss.longitude_deg(i)});
  }
  for (int i = 0; i < heading.time_s_size(); ++i) {
    recording.heading.push_back({heading.time_s(i), heading.heading_deg(i)});
  }
  for (int i = 0; i < thrusters.time_s_size(); ++i) {
    recording.thrusters.push_back(
        {thrusters.time_s(i), thrusters.port_us(i), thrusters.starboard_us(i)});
  }
  return recording;
}

std::string PackChunk(const Recording& recording) {
  return PackBlob(ToProto(recording).SerializeAsString());
}

std::optional<Recording> UnpackChunk(std::string_view blob) {
  const auto bytes = UnpackBlob(blob);
  proto::WindowChunk chunk;
  if (!bytes || !chunk.ParseFromString(*bytes)) return std::nullopt;
  return RecordingOf(chunk);
}

}  // namespace telltale
