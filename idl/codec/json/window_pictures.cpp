#include "telltale/idl/codec/json/window_pictures.hpp"

#include <algorithm>
#include <string>

#include "telltale/idl/codec/json/gap.hpp"

namespace telltale {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

void WritePath(const std::vector<Eigen::Vector2d>& path, Numbers& numbers) {
  for (const Eigen::Vector2d& point : path) numbers.Add(point.begin(), point.end());
}

void Write(const WindowPicture& picture, proto::WindowPicture& message) {
  message.set_time_s(picture.time_s);
  message.set_before(picture.before);
  message.set_after(picture.after);
  message.set_psi_rad(picture.psi_rad);
  message.set_speed_m_s(picture.speed_m_s);
  message.set_propeller_region(RegionOf(picture.region));
  message.mutable_error_before()->Add(picture.error_before.begin(), picture.error_before.end());
  message.mutable_error_after()->Add(picture.error_after.begin(), picture.error_after.end());
}

void WritePaths(const WindowPicture& picture, proto::WindowPicture& message) {
  WritePath(picture.measured, *message.mutable_measured());
  WritePath(picture.predicted_before, *message.mutable_predicted_before());
  WritePath(picture.predicted_after, *message.mutable_predicted_after());
}

std::vector<Eigen::Vector2d> ReadPath(FieldReader& reader, const char* field,
                                      const Numbers& numbers) {
  if (numbers.size() % 2 != 0) {
    reader.Fail(field, std::to_string(numbers.size()) + " numbers", "pairs of north and east");
    return {};
  }
  std::vector<Eigen::Vector2d> path;
  for (int i = 0; i < numbers.size(); i += 2) path.emplace_back(numbers[i], numbers[i + 1]);
  return path;
}

Eigen::Vector3d ReadErrors(FieldReader& reader, const char* field, const Numbers& numbers) {
  if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
  reader.Fail(field, std::to_string(numbers.size()) + " numbers",
              "3: along, across and in heading");
  return Eigen::Vector3d::Zero();
}

}  // namespace

std::vector<std::size_t> WorstWindows(const std::vector<WindowPicture>& pictures) {
  std::vector<std::size_t> windows;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (!pictures[i].measured.empty()) windows.push_back(i);
  }
  std::stable_sort(windows.begin(), windows.end(), [&](std::size_t a, std::size_t b) {
    return pictures[a].before > pictures[b].before;
  });
  windows.resize(std::min(windows.size(), kShownPaths));
  std::sort(windows.begin(), windows.end());
  return windows;
}

void WritePictures(const std::vector<WindowPicture>& pictures, proto::Report& report) {
  for (const WindowPicture& picture : pictures) Write(picture, *report.add_pictures());
  for (const std::size_t i : WorstWindows(pictures)) {
    WritePaths(pictures[i], *report.mutable_pictures(static_cast<int>(i)));
  }
}

WindowPicture ReadPicture(FieldReader reader, const proto::WindowPicture& message) {
  WindowPicture picture;
  picture.time_s = reader.Number("time_s", kNotNan);
  picture.before = reader.Number("before", kNotNegative);
  picture.after = reader.Number("after", kNotNegative);
  picture.psi_rad = reader.Number("psi_rad", kNotNan);
  picture.speed_m_s = reader.Number("speed_m_s", kNotNegative);
  const auto region = ReadRegion(reader, message.propeller_region());
  if (!region) reader.Fail("propeller_region", "ALL", "one of FF, FR, RF, RR");
  picture.region = region.value_or(PropellerRegion::kFF);
  picture.error_before = ReadErrors(reader, "error_before", message.error_before());
  picture.error_after = ReadErrors(reader, "error_after", message.error_after());
  picture.measured = ReadPath(reader, "measured", message.measured());
  picture.predicted_before = ReadPath(reader, "predicted_before", message.predicted_before());
  picture.predicted_after = ReadPath(reader, "predicted_after", message.predicted_after());
  return picture;
}

}  // namespace telltale
