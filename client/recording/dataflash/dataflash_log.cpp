#include "telltale/client/recording/dataflash/dataflash_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "telltale/client/recording/further_part.hpp"
#include "telltale/client/recording/pulse_columns.hpp"

namespace telltale {
namespace {

constexpr double kStatusFix3d = 3.0;
constexpr double kLeapAheadS = 60.0;

enum class Message { kOther, kGps, kAtt, kAhr2, kRcou, kParm };

/// How the records of one type are read: columns found once, at the definition.
struct MessageColumns {
  Message message = Message::kOther;
  std::string name;
  std::string fault;  ///< what the definition lacks; empty when its records can be read
  DataFlashColumn time;
  double tick_s = 0.0;
  std::vector<DataFlashColumn> values;      ///< in the order the message's own taker expects
  std::optional<DataFlashColumn> instance;  ///< GPS of newer firmware
  int fixed_instance = 0;                   ///< GPS of older firmware: one message a receiver
};

Message MessageNamed(std::string_view name) {
  if (name == "GPS" || name == "GPS2" || name == "GPSB") return Message::kGps;
  if (name == "ATT") return Message::kAtt;
  if (name == "AHR2") return Message::kAhr2;
  if (name == "RCOU") return Message::kRcou;
  if (name == "PARM") return Message::kParm;
  return Message::kOther;
}

/// Finds the column of the autopilot's clock. TimeMS in a GPS message is the time of the GPS week,
/// another clock: there the autopilot's is T.
bool BindTime(const DataFlashFormat& format, MessageColumns& reading) {
  const DataFlashColumn* us = format.Find("TimeUS");
  const DataFlashColumn* ms = format.Find(reading.message == Message::kGps ? "T" : "TimeMS");
  if (us == nullptr && ms == nullptr) return false;
  reading.time = us != nullptr ? *us : *ms;
  reading.tick_s = us != nullptr ? 1e-6 : 1e-3;
  return true;
}

const DataFlashColumn* FindOutput(const DataFlashFormat& format, int channel) {
  for (const char* prefix : {"C", "Ch", "Chan"}) {
    if (const auto* column = format.Find(prefix + std::to_string(channel))) return column;
  }
  return nullptr;
}

void BindOutputs(const DataFlashFormat& format, MessageColumns& reading) {
  for (int channel = 1; channel <= kLoggedChannels; ++channel) {
    const DataFlashColumn* column = FindOutput(format, channel);
    if (column == nullptr) break;
    reading.values.push_back(*column);
  }
  if (reading.values.empty()) reading.fault = "RCOU without C1";
}

void BindColumns(const DataFlashFormat& format, std::initializer_list<const char*> labels,
                 MessageColumns& reading) {
  for (const char* label : labels) {
    const DataFlashColumn* column = format.Find(label);
    if (column == nullptr) {
      reading.fault = format.name + " without " + label;
      return;
    }
    reading.values.push_back(*column);
  }
}

void BindInstance(const DataFlashFormat& format, MessageColumns& reading) {
  if (const DataFlashColumn* column = format.Find("I")) reading.instance = *column;
  reading.fixed_instance = format.name == "GPSB" ? 2 : format.name == "GPS2" ? 1 : 0;
}

MessageColumns Bind(const DataFlashFormat& format) {
  MessageColumns reading;
  reading.message = MessageNamed(format.name);
  reading.name = format.name;
  switch (reading.message) {
    case Message::kOther: return reading;
    case Message::kParm: BindColumns(format, {"Name", "Value"}, reading); return reading;
    case Message::kGps:
      BindColumns(format, {"Status", "Lat", "Lng"}, reading);
      BindInstance(format, reading);
      break;
    case Message::kAtt:
    case Message::kAhr2: BindColumns(format, {"Yaw"}, reading); break;
    case Message::kRcou: BindOutputs(format, reading); break;
  }
  if (!BindTime(format, reading)) {
    const bool is_gps = reading.message == Message::kGps;
    reading.fault = format.name + (is_gps ? " without TimeUS or T" : " without TimeUS or TimeMS");
  }
  return reading;
}

/// Gathers what the messages say; choices between sources wait until the log has ended.
class DataFlashLogBuilder : public DataFlashConsumer {
 public:
  explicit DataFlashLogBuilder(std::size_t most_bytes) : memory_(most_bytes) {}

  void Define(const DataFlashFormat& format) override { readings_[format.type] = Bind(format); }

  void Take(const DataFlashFormat& format, DataFlashBytes record) override {
    const MessageColumns& reading = readings_[format.type];
    if (reading.message == Message::kOther) return;
    if (!reading.fault.empty()) {
      ++report_.unreadable[reading.fault];
      return;
    }
    switch (reading.message) {
      case Message::kGps: TakeFix(reading, record); break;
      case Message::kAtt: TakeYaw(reading, record, attitude_); break;
      case Message::kAhr2: TakeYaw(reading, record, backup_attitude_); break;
      case Message::kRcou: TakePulses(reading, record); break;
      case Message::kParm: TakeParameter(reading, record); break;
      case Message::kOther: break;
    }
  }

  DataFlashLog Finish(const DataFlashOptions& options) {
    DataFlashLog log;
    log.report = std::move(report_);
    log.report.left_out = memory_.Summary();
    ChooseReceiver(options, log);
    ChooseHeading(log);
    ChooseThrusters(options, log);
    return log;
  }

 private:
  double TimeOf(const MessageColumns& reading, DataFlashBytes record, int instance = 0) {
    const double time_s = DataFlashNumber(record, reading.time) * reading.tick_s;
    auto [newest, is_first] = newest_s_.try_emplace({reading.message, instance}, time_s);
    if (is_first) return time_s;
    const double step_s = time_s - newest->second;
    if (!(0.0 <= step_s && step_s <= kLeapAheadS)) ++report_.time_leaps[reading.name];
    newest->second = time_s;
    return time_s;
  }

  void TakeFix(const MessageColumns& reading, DataFlashBytes record) {
    const int instance = reading.instance ? InstanceOf(DataFlashNumber(record, *reading.instance))
                                          : reading.fixed_instance;
    const double time_s = TimeOf(reading, record, instance);
    if (!(DataFlashNumber(record, reading.values[0]) >= kStatusFix3d)) {
      ++report_.gps_without_fix;
      return;
    }
    ++report_.gps_fixes[instance];
    fixes_.try_emplace(instance, memory_)
        .first->second.Add({time_s, DataFlashNumber(record, reading.values[1]),
                            DataFlashNumber(record, reading.values[2])});
  }

  static int InstanceOf(double number) {
    return number >= 0.0 && number <= 255.0 ? static_cast<int>(number) : 0;
  }

  void TakeYaw(const MessageColumns& reading, DataFlashBytes record,
               SampleSeries<HeadingSample>& series) {
    series.Add({TimeOf(reading, record), DataFlashNumber(record, reading.values[0])});
  }

  void TakePulses(const MessageColumns& reading, DataFlashBytes record) {
    std::array<float, kLoggedChannels> pulse_us{};
    pulse_us.fill(std::numeric_limits<float>::quiet_NaN());  // where the firmware logs fewer
    for (std::size_t i = 0; i < reading.values.size(); ++i) {
      pulse_us[i] = static_cast<float>(DataFlashNumber(record, reading.values[i]));
    }
    pulses_.Add(TimeOf(reading, record), pulse_us);
  }

  void TakeParameter(const MessageColumns& reading, DataFlashBytes record) {
    const std::string_view name = DataFlashText(record, reading.values[0]);
    if (!IsOutputParameter(name)) return;  // whatever else a damaged log names
    const double value = DataFlashNumber(record, reading.values[1]);
    if (!std::isfinite(value)) return;
    auto [parameter, is_new] = parameters_.try_emplace(std::string(name), value);
    if (is_new || parameter->second == value) return;
    parameter->second = value;
    ++report_.changed_parameters[parameter->first];
  }

  void ChooseReceiver(const DataFlashOptions& options, DataFlashLog& log) {
    auto chosen = fixes_.end();
    if (options.gps_instance) {
      chosen = fixes_.find(*options.gps_instance);
    } else {
      chosen = std::max_element(fixes_.begin(), fixes_.end(), [](const auto& a, const auto& b) {
        return a.second.Samples().size() < b.second.Samples().size();
      });
    }
    if (chosen == fixes_.end()) return;
    log.report.gps_instance = chosen->first;
    log.gnss = std::move(chosen->second).Release();
  }

  void ChooseHeading(DataFlashLog& log) {
    if (!attitude_.Samples().empty()) {
      log.report.heading_source = HeadingSource::kAtt;
      log.heading = std::move(attitude_).Release();
    } else if (!backup_attitude_.Samples().empty()) {
      log.report.heading_source = HeadingSource::kAhr2;
      log.heading = std::move(backup_attitude_).Release();
    }
  }

  void ChooseThrusters(const DataFlashOptions& options, DataFlashLog& log) {
    const auto choose = [&](std::optional<int> asked, int function) {
      const auto channel = asked ? asked : ChannelWithFunction(parameters_, function);
      return channel ? std::optional(OutputOn(parameters_, *channel)) : std::nullopt;
    };
    log.port = choose(options.port_channel, kThrottleLeft);
    log.starboard = choose(options.starboard_channel, kThrottleRight);
    if (!log.port || !log.starboard) return;
    if (std::max(log.port->channel, log.starboard->channel) > kLoggedChannels) return;
    if (SameChannel(log.port->channel, log.starboard->channel)) return;
    log.thrusters = pulses_.Of(log.port->channel, log.starboard->channel);
  }

  std::array<MessageColumns, 256> readings_;
  std::map<std::pair<Message, int>, double> newest_s_;
  SampleMemory memory_;
  std::map<int, SampleSeries<GnssFix>> fixes_;
  SampleSeries<HeadingSample> attitude_{memory_};
  SampleSeries<HeadingSample> backup_attitude_{memory_};
  PulseColumns pulses_{memory_};
  AutopilotParameters parameters_;
  DataFlashReport report_;
};

DataFlashLog FinishLog(DataFlashLogBuilder& builder, const DataFlashFraming& framing,
                       std::uint64_t bytes, const DataFlashOptions& options) {
  DataFlashLog log = builder.Finish(options);
  log.report.bytes = bytes;
  log.report.records = framing.RecordsByName();
  log.report.damage = framing.Damage();
  return log;
}

std::uint64_t CountOf(const DataFlashReport& report, const std::string& name) {
  const auto found = report.records.find(name);
  return found == report.records.end() ? 0 : found->second;
}

std::optional<Refusal> OutOfRange(const char* field, std::optional<int> value, int low, int high) {
  if (!value || (low <= *value && *value <= high)) return std::nullopt;
  const std::string range = "[" + std::to_string(low) + ", " + std::to_string(high) + "]";
  return Refusal{field, std::to_string(*value) + " is outside " + range,
                 std::string("give ") + field + " a value in " + range};
}

Refusal LacksFix(const DataFlashReport& report) {
  if (!report.gps_fixes.empty()) {
    std::string have;
    for (const auto& [instance, fixes] : report.gps_fixes)
      have.append(" ").append(std::to_string(instance));
    return {"gnss", "the GPS instance asked for has no fix", "ask for one of:" + have};
  }
  if (report.gps_without_fix > 0) {
    return {"gnss",
            "no fix: Status is below 3 in all " + std::to_string(report.gps_without_fix) +
                " GPS records",
            "wait for a 3D fix before the run"};
  }
  return {"gnss", "no GPS message that can be read", "enable GPS (bit 2) in LOG_BITMASK"};
}

Refusal LacksThrusters(const DataFlashLog& log) {
  if (CountOf(log.report, "RCOU") == 0) {
    return {"thrusters", "no RCOU message",
            "enable RC output (Rover: RC Input-Output, bit 14) in LOG_BITMASK"};
  }
  for (const auto& [output, function] : {std::pair(&log.port, "73 (ThrottleLeft)"),
                                         std::pair(&log.starboard, "74 (ThrottleRight)")}) {
    if (!*output) {
      return {"thrusters", std::string("no PARM record gives a SERVOn_FUNCTION ") + function,
              "name the channel that drives this thruster"};
    }
    if ((*output)->channel > kLoggedChannels) {
      return {"thrusters", "channel " + std::to_string((*output)->channel) + " drives a thruster",
              "use channels 1 to 14, which RCOU records"};
    }
  }
  if (auto shared = SameChannel(log.port->channel, log.starboard->channel)) return *shared;
  return {"thrusters", "no RCOU message that can be read", "log RCOU with TimeUS and C1..C14"};
}

void AppendCounts(std::ostream& out, std::uint64_t count, const char* what) {
  if (count > 0) out << "; " << count << ' ' << what;
}

void AppendCounts(std::ostream& out, const std::map<std::string, std::uint64_t>& counts,
                  const char* what) {
  for (const auto& [name, count] : counts) out << "; " << count << ' ' << what << ' ' << name;
}

}  // namespace

std::string_view Name(HeadingSource source) {
  switch (source) {
    case HeadingSource::kUnknown: return "none";
    case HeadingSource::kAtt: return "ATT";
    case HeadingSource::kAhr2: return "AHR2";
  }
  return "";
}

std::optional<Refusal> DataFlashOptions::Validate() const {
  if (auto refusal = OutOfRange("gps_instance", gps_instance, 0, 255)) return refusal;
  if (auto refusal = OutOfRange("port_channel", port_channel, 1, kLoggedChannels)) return refusal;
  if (auto refusal = OutOfRange("starboard_channel", starboard_channel, 1, kLoggedChannels)) {
    return refusal;
  }
  return SameChannel(port_channel, starboard_channel);
}

std::string DataFlashReport::Summary() const {
  std::uint64_t total = 0;
  for (const auto& [name, count] : records) total += count;
  std::ostringstream out;
  out << total << " records in " << bytes << " bytes";
  if (gps_instance) out << "; positions from GPS instance " << *gps_instance;
  if (heading_source != HeadingSource::kUnknown) out << "; heading from " << Name(heading_source);
  AppendCounts(out, gps_without_fix, "GPS records without a fix");
  AppendCounts(out, time_leaps, "leaps in time in");
  AppendCounts(out, unreadable, "unreadable records:");
  AppendCounts(out, changed_parameters, "changes of");
  AppendCounts(out, damage.corrupt_records, "corrupt records");
  AppendCounts(out, damage.undefined_records, "records of undefined type");
  AppendCounts(out, damage.malformed_definitions, "malformed definitions");
  AppendCounts(out, damage.redefinitions, "redefinitions");
  AppendCounts(out, damage.skipped_bytes, "bytes skipped");
  AppendCounts(out, damage.truncated_bytes, "bytes of a record cut off at the end");
  out << FurtherPart(left_out);
  return out.str();
}

std::optional<Refusal> DataFlashLog::Unreadable() const {
  if (report.bytes == 0) return Refusal{"log", "the file is empty", "download the log again"};
  if (CountOf(report, "FMT") == 0) {
    return Refusal{
        "log",
        "not a DataFlash log: no FMT record in its " + std::to_string(report.bytes) + " bytes",
        "give an ArduPilot .BIN log or a folder of CSV files"};
  }
  return std::nullopt;
}

std::vector<Refusal> DataFlashLog::Lacks() const {
  std::vector<Refusal> lacks;
  if (gnss.empty()) lacks.push_back(LacksFix(report));
  if (heading.empty()) {
    lacks.push_back({"heading", "no ATT or AHR2 message that can be read",
                     "enable attitude (bit 0 or 1) in LOG_BITMASK"});
  }
  if (thrusters.empty()) lacks.push_back(LacksThrusters(*this));
  return lacks;
}

DataFlashLog ParseDataFlash(DataFlashBytes bytes, const DataFlashOptions& options) {
  DataFlashLogBuilder builder(options.memory_bytes);
  DataFlashFraming framing(builder);
  framing.Consume(bytes, true);
  return FinishLog(builder, framing, bytes.size(), options);
}

Result<DataFlashLog> ReadDataFlash(const std::filesystem::path& file,
                                   const DataFlashOptions& options, const ReadProgress& progress) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  DataFlashLogBuilder builder(options.memory_bytes);
  DataFlashFraming framing(builder);
  const auto total = ReadInBlocks(
      file, [&](DataFlashBytes bytes, bool at_end) { return framing.Consume(bytes, at_end); },
      progress);
  if (!total) return tl::unexpected(total.error());

  DataFlashLog log = FinishLog(builder, framing, *total, options);
  if (auto refusal = log.Unreadable()) {
    refusal->subject = file.string() + " " + refusal->subject;
    return tl::unexpected(*std::move(refusal));
  }
  return log;
}

}  // namespace telltale
