#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "support/compression.hpp"
#include "support/little_endian.hpp"

namespace {

using telltale::Bz2;
using telltale::Gzip;
using telltale::LittleEndian;
using telltale::Lz4;
using telltale::WithLength;
using telltale::Zstd;
using Bytes = std::string;

void Save(const std::filesystem::path& file, const Bytes& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

// ---- compression --------------------------------------------------------------------------------

/// As recordings name compressions.
Bytes Compressed(const Bytes& bytes, const Bytes& compression) {
  if (compression == "zstd") return Zstd(bytes);
  if (compression == "lz4") return Lz4(bytes);
  if (compression == "bz2") return Bz2(bytes);
  return bytes;
}

// ---- MAVLink ------------------------------------------------------------------------------------

/// Three frames whose checksums hold: GPS_RAW_INT, SERVO_OUTPUT_RAW and a signed ATTITUDE.
std::vector<Bytes> Frames() {
  const std::vector<std::vector<int>> frames = {
      {0xfd, 0x1e, 0x00, 0x00, 0x05, 0x07, 0x01, 0x18, 0x00, 0x00, 0x14, 0x1a, 0x99, 0xbe,
       0x1c, 0x00, 0x00, 0x00, 0x80, 0x12, 0xca, 0x25, 0x00, 0x16, 0xcd, 0xf9, 0xe8, 0x03,
       0x00, 0x00, 0x64, 0x00, 0xc8, 0x00, 0x32, 0x00, 0x28, 0x23, 0x03, 0x0b, 0x4e, 0x16},
      {0xfd, 0x0a, 0x00, 0x00, 0x06, 0x07, 0x01, 0x24, 0x00, 0x00, 0x00,
       0x09, 0x3d, 0x00, 0x40, 0x06, 0x00, 0x00, 0x78, 0x05, 0x95, 0x35},
      {0xfd, 0x10, 0x01, 0x00, 0x07, 0x07, 0x01, 0x1e, 0x00, 0x00, 0xc4, 0x09, 0x00, 0x00,
       0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x3f, 0x35, 0x09,
       0x01, 0x00, 0xe0, 0x6f, 0x9e, 0x75, 0x19, 0x59, 0x20, 0x7a, 0x61, 0x39, 0x22}};
  std::vector<Bytes> all;
  for (const std::vector<int>& frame : frames) all.emplace_back(frame.begin(), frame.end());
  return all;
}

Bytes TelemetryLog(const std::vector<Bytes>& frames) {
  const Bytes arrival("\x00\x05\xfa\xea\x6c\xd6\x2a\x00", 8);  // in 2023
  Bytes log;
  for (const Bytes& frame : frames) log += arrival + frame;
  return log;
}

/// As mavlink_fuzz takes messages without a frame: id, length, payload.
Bytes Messages() {
  Bytes bytes;
  for (const auto& [id, length] : {std::pair(24, 30), std::pair(33, 28), std::pair(30, 28),
                                   std::pair(36, 37), std::pair(22, 25), std::pair(2, 12)}) {
    bytes += static_cast<char>(id);
    bytes += static_cast<char>(length);
    bytes += Bytes(static_cast<std::size_t>(length), '\x11');
  }
  return bytes;
}

// ---- MCAP ---------------------------------------------------------------------------------------

Bytes Record(char opcode, const Bytes& content) {
  return Bytes(1, opcode) + LittleEndian(static_cast<std::uint64_t>(content.size())) + content;
}

Bytes Channel(std::uint16_t id, const Bytes& topic, const Bytes& type, const Bytes& encoding) {
  return Record(3, LittleEndian(id) + WithLength(type) + WithLength("ros2msg") + WithLength("")) +
         Record(4, LittleEndian(id) + LittleEndian(id) + WithLength(topic) + WithLength(encoding) +
                       LittleEndian<std::uint32_t>(0));
}

Bytes Message(std::uint16_t channel, const Bytes& data) {
  return Record(5, LittleEndian(channel) + Bytes(20, '\0') + data);
}

Bytes Chunk(const Bytes& records, const Bytes& compression) {
  const Bytes packed = Compressed(records, compression);
  return Record(6, Bytes(16, '\0') + LittleEndian(static_cast<std::uint64_t>(records.size())) +
                       Bytes(4, '\0') + WithLength(compression) +
                       LittleEndian(static_cast<std::uint64_t>(packed.size())) + packed);
}

Bytes Mcap(const Bytes& records) {
  const Bytes magic("\x89MCAP0\r\n", 8);
  return magic + Record(1, WithLength("ros2") + WithLength("seeds")) + records +
         Record(15, Bytes(4, '\0')) + magic;
}

/// With an index of each chunk and a summary, by which chunks are passed over.
Bytes IndexedMcap(const Bytes& definitions, const Bytes& chunks, std::uint32_t channels) {
  const Bytes magic("\x89MCAP0\r\n", 8);
  const Bytes data = magic + definitions + chunks + Record(15, Bytes(4, '\0'));
  const Bytes statistics = Record(11, Bytes(10, '\0') + LittleEndian(channels) + Bytes(30, '\0'));
  const Bytes footer =
      Record(2, LittleEndian(static_cast<std::uint64_t>(data.size())) + Bytes(12, '\0'));
  return data + definitions + statistics + footer + magic;
}

Bytes MessageIndex(std::uint16_t channel, std::uint64_t offset) {
  return Record(7, LittleEndian(channel) + WithLength(Bytes(8, '\0') + LittleEndian(offset)));
}

Bytes RosRecords() {
  const Bytes cdr("\x00\x01\x00\x00", 4);
  return Channel(1, "/compass_hdg", "std_msgs/msg/Float64", "cdr") +
         Channel(2, "/gps/fix", "sensor_msgs/msg/NavSatFix", "cdr") +
         Channel(3, "/rc/out", "mavros_msgs/msg/RCOut", "cdr") +
         Message(1, cdr + Bytes(8, '\x40')) + Message(2, cdr + Bytes(60, '\0')) +
         Message(3, cdr + Bytes(12, '\0') + LittleEndian<std::uint32_t>(4) + Bytes(8, '\x05'));
}

Bytes BlueOsRecords() {
  const auto message = [](std::uint16_t id, const Bytes& body) {
    return Channel(id, "mavlink/1/1/X", "X", "json") +
           Message(id, R"({"header":{"system_id":1},"message":{"type":)" + body + "}}");
  };
  return message(1, R"("ATTITUDE","time_boot_ms":1,"yaw":0.5)") +
         message(2, R"("GPS_RAW_INT","time_usec":1,"lat":1,"lon":2,"fix_type":{"type":"A"})") +
         message(3, R"("SERVO_OUTPUT_RAW","time_usec":1,"port":0,"servo1_raw":1500)") +
         message(4, R"("PARAM_VALUE","param_id":["S","\u0000"],"param_value":73.0)") +
         message(5, R"("SYSTEM_TIME","time_unix_usec":1,"time_boot_ms":2)") +
         message(6, R"("GLOBAL_POSITION_INT","time_boot_ms":1,"lat":1,"lon":2,"hdg":3)");
}

// ---- ROS 1 --------------------------------------------------------------------------------------

Bytes BagRecord(const Bytes& header, const Bytes& data) {
  return WithLength(header) + WithLength(data);
}

Bytes BagRecords() {
  const Bytes id = WithLength(Bytes("conn=") + Bytes(4, '\0'));
  return BagRecord(WithLength("op=\x07") + id + WithLength("topic=/fix"),
                   WithLength("type=sensor_msgs/NavSatFix")) +
         BagRecord(WithLength("op=\x02") + id + WithLength(Bytes("time=") + Bytes(8, '\x01')),
                   Bytes(120, '\0'));
}

Bytes Bag(const Bytes& compression) {
  const Bytes records = BagRecords();
  const Bytes size = LittleEndian(static_cast<std::uint32_t>(records.size()));
  return "#ROSBAG V2.0\n" +
         BagRecord(WithLength("op=\x05") + WithLength("compression=" + compression) +
                       WithLength("size=" + size),
                   Compressed(records, compression));
}

// ---- CSV ----------------------------------------------------------------------------------------

/// As csv_fuzz names columns.
Bytes Csv(char separator) {
  Bytes rows = "t,lat,lon,yaw,left,right\n0,63.4,10.4,12.5,1500,1600\n100,,,13,1510,\n";
  std::replace(rows.begin(), rows.end(), ',', separator);
  return rows;
}

/// The same with times of ISO 8601 of every form.
Bytes IsoCsv() {
  return "t,lat,lon,yaw,left,right\n2023-11-14 22:13:20.5,63.4,10.4,12.5,1500,1600\n"
         "2023-11-14T22:13:21Z,63.4,10.4,13,1510,1600\n2023-11-14T23:13:22+01:00,,,14,1510,\n";
}

/// As csv_fuzz names columns of the other forms: stamps, metres, a quaternion and newtons.
Bytes OtherFormsCsv() {
  return "stamp.sec,stamp.nanosec,north,east,q.x,q.y,q.z,q.w,left,right\n"
         "1700000000,500000000,0,0,0,0,0,1,0,0\n1700000000,600000000,0,0,0,0,0.1,0.99,120,-90\n"
         "1700000001,0,0.5,0.25,0,0,0.1,0.99,250,-180\n";
}

/// As telemetry_fuzz takes a folder: twenty seconds on a circle, a file after the other.
Bytes TelemetryFolder(const Bytes& end_of_line) {
  constexpr double kRadiusDeg = 1e-4;  // of latitude
  constexpr double kStepRad = 0.05;
  std::ostringstream gnss;
  std::ostringstream heading;
  std::ostringstream thrusters;
  gnss << std::setprecision(11) << "time_s,latitude_deg,longitude_deg" << end_of_line;
  heading << "time_s,heading_deg" << end_of_line;
  thrusters << "time_s,left_us,right_us" << end_of_line;
  for (int i = 0; i < 40; ++i) {
    const double turned = i * kStepRad;
    const double time_s = 0.5 * i;
    gnss << time_s << ',' << 63.4 + kRadiusDeg * std::sin(turned) << ','
         << 10.4 - 2.0 * kRadiusDeg * std::cos(turned) << end_of_line;
    heading << time_s << ',' << turned * 57.3 << end_of_line;
    thrusters << time_s << ',' << 1600 + i % 5 * 20 << ',' << 1550 << end_of_line;
  }
  return gnss.str() + '\f' + heading.str() + '\f' + thrusters.str();
}

// ---- ROS 2 --------------------------------------------------------------------------------------

/// Storage of rosbag2 in pages so small that a mutation meets every part of it.
void SaveStorage(const std::filesystem::path& file, const std::vector<Bytes>& messages) {
  std::filesystem::create_directories(file.parent_path());
  std::filesystem::remove(file);
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec(
      "PRAGMA page_size = 512;"
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT);"
      "CREATE TABLE messages(topic_id INTEGER, timestamp INTEGER, data BLOB);"
      "CREATE TABLE message_definitions(topic_type TEXT, encoded_message_definition TEXT, "
      "encoding TEXT);"
      "INSERT INTO message_definitions VALUES('a/msg/B', 'float64 data', 'ros2msg');"
      "INSERT INTO topics VALUES(1, '/fix', 'sensor_msgs/msg/NavSatFix'),"
      "(2, '/hdg', 'std_msgs/msg/Float64'), (3, '/rc/out', 'mavros_msgs/msg/RCOut'),"
      "(4, '/b', 'a/msg/B')");
  for (std::size_t i = 0; i < messages.size(); ++i) {
    SQLite::Statement insert(database, "INSERT INTO messages VALUES(?, ?, ?)");
    insert.bind(1, static_cast<int>(i % 4 + 1));
    insert.bind(2, static_cast<std::int64_t>(i) * 1'000'000'000);
    insert.bind(3, messages[i].data(), static_cast<int>(messages[i].size()));
    insert.exec();
  }
}

/// A fix, a heading, outputs, and what the storage defines itself.
std::vector<Bytes> StoredMessages() {
  const Bytes cdr("\x00\x01\x00\x00", 4);
  return {cdr + Bytes(116, '\0'), cdr + Bytes(8, '\x40'),
          cdr + Bytes(12, '\0') + LittleEndian<std::uint32_t>(4) + Bytes(8, '\x05'),
          cdr + Bytes(8, '\x41')};
}

/// As ros_fuzz takes messages: topic, length, CDR.
Bytes RosMessages() {
  Bytes bytes;
  for (char topic = 0; topic < 11; ++topic) {
    bytes += topic;
    bytes += static_cast<char>(120);
    bytes += Bytes("\x00\x01\x00\x00", 4) + Bytes(116, '\0');
  }
  return bytes;
}

}  // namespace

/// recording_seeds FOLDER: the recordings from which the fuzzers start, a folder for each.
int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: recording_seeds FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  Save(folder / "csv/comma", Csv(','));
  Save(folder / "csv/semicolon", Csv(';'));
  Save(folder / "csv/iso", IsoCsv());
  Save(folder / "csv/other-forms", OtherFormsCsv());
  const Bytes gzip = Gzip(Csv(','));
  Save(folder / "gzip/whole.gz", gzip);
  Save(folder / "gzip/two.gz", gzip + Gzip(IsoCsv()));
  Save(folder / "gzip/cut.gz", gzip.substr(0, gzip.size() / 2));
  Save(folder / "mavlink/log.tlog", TelemetryLog(Frames()));
  Save(folder / "mavlink/stream", Frames()[0] + Frames()[1] + Frames()[2]);
  Save(folder / "mavlink/bare", Frames()[2] + "noise" + Frames()[0] + Frames()[1]);
  Save(folder / "mavlink/messages", Messages());
  Save(folder / "mcap/ros.mcap", Mcap(RosRecords()));
  Save(folder / "mcap/chunk.mcap", Mcap(Chunk(RosRecords(), "")));
  Save(folder / "mcap/zstd.mcap", Mcap(Chunk(RosRecords(), "zstd")));
  Save(folder / "mcap/lz4.mcap", Mcap(Chunk(RosRecords(), "lz4")));
  const Bytes unwanted = Channel(9, "/camera", "sensor_msgs/msg/Image", "cdr");
  Save(folder / "mcap/indexed.mcap",
       IndexedMcap(unwanted, Chunk(Message(9, "picture"), "") + MessageIndex(9, 0), 1));
  Save(folder / "mcap/blueos.mcap", Mcap(BlueOsRecords()));
  Save(folder / "telemetry/log", TelemetryFolder("\n"));
  Save(folder / "telemetry/of-windows", TelemetryFolder("\r\n"));
  Save(folder / "zstd/whole.zst", Zstd(Csv(',')));
  Save(folder / "zstd/two.zst", Zstd(Csv(',')) + Zstd(IsoCsv()));
  Save(folder / "zstd/cut.zst", Zstd(IsoCsv()).substr(0, 40));
  Save(folder / "zstd/run.zst", Zstd(Bytes(100'000, ' ')));
  std::vector<Bytes> messages = StoredMessages();
  SaveStorage(folder / "rosbag2/plain.db3", messages);
  for (Bytes& message : messages) message = Zstd(message);
  SaveStorage(folder / "rosbag2/by-message.db3", messages);
  Save(folder / "rosbag2/chunk.mcap", Mcap(Chunk(RosRecords(), "zstd")));
  Save(folder / "rosbag2/whole.mcap.zst", Zstd(Mcap(RosRecords())));
  Save(folder / "ros/messages", RosMessages());
  for (const char* compression : {"none", "bz2", "lz4"}) {
    Save(folder / "rosbag1" / compression, Bag(compression));
  }
}
