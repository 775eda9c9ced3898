#include "telltale/client/recording/mapping/mapped_samples.hpp"

#include <cmath>
#include <utility>

#include "telltale/client/recording/odometry_origin.hpp"
#include "telltale/core/base/degrees.hpp"

namespace telltale {
namespace {

std::string CountText(std::uint64_t count, const std::string& what) {
  return count > 0 ? "; " + std::to_string(count) + ' ' + what : std::string();
}

std::string Place(const std::string& topic, const std::string& fields) {
  return topic.empty() ? fields : topic + ' ' + fields;
}

std::string TimeText(const MappedTime& time) {
  return time.field.empty() ? "times of recording" : "times from " + time.field;
}

std::string CommandText(const MappedThruster& thruster) {
  if (thruster.is_pulse) return "us";
  const auto number = [](double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
  };
  return number(thruster.full_reverse) + " to " + number(thruster.full_forward) +
         " taken as 1100 to 1900 us";
}

std::string OthersText(const std::set<std::string, std::less<>>& others) {
  std::string text;
  for (const std::string& topic : others) text += (text.empty() ? "" : ", ") + topic;
  return text.empty() ? "" : "; left out, though the mapping matches: " + text;
}

/// A pattern and a topic in a form to compare: some recorders begin topics with a slash, others do
/// not.
struct ComparedTopic {
  ComparedTopic(std::string_view of_pattern, std::string_view of_topic)
      : pattern(of_pattern), topic(of_topic) {
    // A star stands for the slash too.
    if (pattern.empty() || pattern.starts_with('*')) return;
    if (pattern.starts_with('/')) pattern.remove_prefix(1);
    if (topic.starts_with('/')) topic.remove_prefix(1);
  }

  std::string_view pattern;
  std::string_view topic;
};

/// What the first star of a pattern stands for in a topic that it matches.
std::string_view FirstStarIn(const ComparedTopic& compared) {
  const auto [pattern, topic] = compared;
  const std::size_t star = pattern.find('*');
  const std::string_view behind = pattern.substr(star + 1);
  const std::string_view next = behind.substr(0, behind.find('*'));
  const bool is_last = next.size() == behind.size();
  const std::size_t end = is_last ? topic.size() - next.size() : topic.find(next, star);
  return topic.substr(star, end - star);
}

/// Whether one is the other or goes on below it.
bool AreOneNamespace(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) std::swap(a, b);
  return b.starts_with(a) &&
         (a.size() == b.size() || a.empty() || a.ends_with('/') || b[a.size()] == '/');
}

}  // namespace

bool TopicMatches(std::string_view of_pattern, std::string_view of_topic) {
  const auto [pattern, topic] = ComparedTopic(of_pattern, of_topic);
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string_view::npos;
  std::size_t resume = 0;
  while (t < topic.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && pattern[p] == topic[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

MappedSamples::MappedSamples(const Mapping& mapping, SampleSink sink)
    : mapping_(mapping), sink_(std::move(sink)) {}

bool MappedSamples::Names(std::string_view topic) const {
  return TopicMatches(mapping_.positions.topic, topic) ||
         TopicMatches(mapping_.headings.topic, topic) || TopicMatches(mapping_.port.topic, topic) ||
         TopicMatches(mapping_.starboard.topic, topic);
}

bool MappedSamples::IsFrom(Source& source, std::string_view pattern, std::string_view topic) {
  if (!TopicMatches(pattern, topic)) return false;
  if (!source.is_taken && IsOfTheBoat(pattern, topic)) {
    source.is_taken = true;
    source.topic = std::string(topic);
  }
  if (source.is_taken && source.topic == topic) return true;
  if (!source.also.contains(topic)) source.also.emplace(topic);
  return false;
}

bool MappedSamples::IsOfTheBoat(std::string_view pattern, std::string_view topic) {
  const ComparedTopic compared(pattern, topic);
  const std::size_t star = compared.pattern.find('*');
  if (star == std::string_view::npos) return true;
  const std::string_view stands_for = FirstStarIn(compared);
  const auto [boat, is_first] =
      boat_.try_emplace(std::string(compared.pattern.substr(0, star)), stands_for);
  return is_first || AreOneNamespace(boat->second, stands_for);
}

std::optional<double> MappedSamples::TimeOf(const MappedTime& time, double received_s,
                                            const MessageFields& fields) {
  if (time.field.empty()) return received_s;
  if (!time.is_stamp) {
    auto value = fields.Number(time.field);
    if (value) *value *= time.unit_s;
    return value;
  }
  const auto seconds = fields.Number(time.field + ".sec");
  auto nanoseconds = fields.Number(time.field + ".nanosec");
  if (!nanoseconds) nanoseconds = fields.Number(time.field + ".nsec");
  if (!seconds || !nanoseconds) return std::nullopt;
  return *seconds + 1e-9 * *nanoseconds;
}

void MappedSamples::Take(std::string_view topic, double received_s, const MessageFields& fields) {
  ++messages_;
  if (IsFrom(positions_, mapping_.positions.topic, topic)) TakePosition(received_s, fields);
  if (IsFrom(headings_, mapping_.headings.topic, topic)) TakeHeading(received_s, fields);
  if (IsFrom(port_, mapping_.port.topic, topic)) {
    TakeCommand(Side::kPort, mapping_.port, received_s, fields, port_);
  }
  if (IsFrom(starboard_, mapping_.starboard.topic, topic)) {
    TakeCommand(Side::kStarboard, mapping_.starboard, received_s, fields, starboard_);
  }
}

void MappedSamples::TakePosition(double received_s, const MessageFields& fields) {
  const MappedPositions& positions = mapping_.positions;
  const auto time_s = TimeOf(positions.time, received_s, fields);
  const auto latitude = fields.Number(positions.latitude);
  const auto longitude = fields.Number(positions.longitude);
  if (!time_s || !latitude || !longitude) {
    ++positions_.absent;
    return;
  }
  // What receivers report until they have a fix.
  if (!positions.is_metres && *latitude == 0.0 && *longitude == 0.0) {
    ++positions_.without_fix;
    return;
  }
  const GeographicPosition place =
      positions.is_metres
          ? PlaceOfOdometry({*latitude, *longitude})
          : GeographicPosition{*latitude * positions.unit_deg, *longitude * positions.unit_deg};
  const GnssFix fix{*time_s, place.latitude_deg, place.longitude_deg};
  const bool repeats = positions.held && last_fix_ && last_fix_->latitude_deg == fix.latitude_deg &&
                       last_fix_->longitude_deg == fix.longitude_deg;
  if (repeats) {
    ++positions_.held;
    return;
  }
  last_fix_ = fix;
  sink_.fix(fix);
}

std::optional<double> MappedSamples::HeadingOf(const MessageFields& fields) const {
  const MappedHeadings& headings = mapping_.headings;
  std::optional<double> angle_deg;
  if (headings.is_quaternion) {
    const auto x = fields.Number(headings.field + ".x");
    const auto y = fields.Number(headings.field + ".y");
    const auto z = fields.Number(headings.field + ".z");
    const auto w = fields.Number(headings.field + ".w");
    if (!x || !y || !z || !w) return std::nullopt;
    if (*x == 0.0 && *y == 0.0 && *z == 0.0 && *w == 0.0) return std::nullopt;
    angle_deg =
        kDegreesPerRadian * std::atan2(2.0 * (*w * *z + *x * *y), 1.0 - 2.0 * (*y * *y + *z * *z));
  } else {
    angle_deg = fields.Number(headings.field);
    if (!angle_deg) return std::nullopt;
    *angle_deg *= headings.unit_deg;
  }
  return (headings.is_east_north_up ? 90.0 - *angle_deg : *angle_deg) + headings.offset_deg;
}

void MappedSamples::TakeHeading(double received_s, const MessageFields& fields) {
  const auto time_s = TimeOf(mapping_.headings.time, received_s, fields);
  const auto heading_deg = HeadingOf(fields);
  if (!time_s || !heading_deg) {
    ++headings_.absent;
  } else if (mapping_.headings.held && last_heading_deg_ == heading_deg) {
    ++headings_.held;
  } else {
    last_heading_deg_ = heading_deg;
    sink_.heading({*time_s, *heading_deg});
  }
}

void MappedSamples::TakeCommand(Side side, const MappedThruster& thruster, double received_s,
                                const MessageFields& fields, Source& source) {
  const auto time_s = TimeOf(thruster.time, received_s, fields);
  const auto value = fields.Number(thruster.field);
  if (!time_s || !value) {
    ++source.absent;
    return;
  }
  const bool is_ahead = *value / thruster.full_forward >= 0.0;
  const double share = is_ahead ? *value / thruster.full_forward : -*value / thruster.full_reverse;
  sink_.command(side, {*time_s, thruster.is_pulse ? *value : PulseOfShare(share)});
}

std::string MappedSamples::Summary(const char* what) const {
  std::string text =
      std::to_string(messages_) + ' ' + what + " that mapping " + mapping_.name + " names";
  if (positions_.is_taken) {
    text += "; positions from " +
            Place(positions_.topic,
                  mapping_.positions.latitude + " and " + mapping_.positions.longitude) +
            (mapping_.positions.is_metres ? ", metres from " + OdometryOriginText() : "") + ", " +
            TimeText(mapping_.positions.time) + OthersText(positions_.also);
  }
  if (headings_.is_taken) {
    text += "; heading from " + Place(headings_.topic, mapping_.headings.field) +
            (mapping_.headings.is_east_north_up ? ", east-north-up" : ", clockwise from north") +
            ", " + TimeText(mapping_.headings.time) + OthersText(headings_.also);
  }
  if (port_.is_taken) {
    text += "; port commands from " + Place(port_.topic, mapping_.port.field) + ", " +
            CommandText(mapping_.port) + OthersText(port_.also);
  }
  if (starboard_.is_taken) {
    text += "; starboard commands from " + Place(starboard_.topic, mapping_.starboard.field) +
            ", " + CommandText(mapping_.starboard) + OthersText(starboard_.also);
  }
  const std::string of = std::string(what) + " without ";
  text += CountText(positions_.absent, of + "a position") +
          CountText(positions_.without_fix, "positions without a fix, at 0, 0") +
          CountText(positions_.held, "repeat the fix before") +
          CountText(headings_.absent, of + "a heading") +
          CountText(headings_.held, "repeat the heading before") +
          CountText(port_.absent, of + "a port command") +
          CountText(starboard_.absent, of + "a starboard command");
  return text;
}

}  // namespace telltale
