#include "telltale/client/recording/rosbag2/rosbag2.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "telltale/client/recording/block_reader.hpp"
#include "telltale/client/recording/mcap/mcap_file.hpp"
#include "telltale/client/recording/ros/idl_definition.hpp"
#include "telltale/client/recording/ros_intake.hpp"
#include "telltale/client/recording/temporary_file.hpp"
#include "telltale/client/recording/zstd_frame.hpp"

namespace telltale {
namespace {

namespace fs = std::filesystem;

bool IsOfRosbag2(fs::path file) {
  if (file.extension() == ".zstd") file = file.stem();
  return file.extension() == ".db3" || file.extension() == ".mcap";
}

std::vector<fs::path> FilesOf(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (IsOfRosbag2(entry.path())) files.push_back(entry.path());
  }
  // bag_2 comes before bag_10.
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return strverscmp(a.c_str(), b.c_str()) < 0;
  });
  return files;
}

/// Definitions of message types, which newer recordings hold, by type.
std::map<std::string, std::string> DefinitionsIn(const SQLite::Database& database) {
  std::map<std::string, std::string> definitions;
  if (!database.tableExists("message_definitions")) return definitions;
  SQLite::Statement rows(database,
                         "SELECT topic_type, encoded_message_definition, encoding = 'ros2idl' "
                         "FROM message_definitions WHERE encoding IN ('ros2msg', 'ros2idl')");
  while (rows.executeStep()) {
    const std::string definition = rows.getColumn(1).getString();
    const bool is_idl = rows.getColumn(2).getInt() != 0;
    definitions[rows.getColumn(0).getString()] =
        is_idl ? RosDefinitionOfIdl(definition) : definition;
  }
  return definitions;
}

/// Who takes the messages of the topics of use, by their numbers.
std::map<std::int64_t, MessageTaker> TopicsIn(const SQLite::Database& database,
                                              RosIntake& recording) {
  std::map<std::string, std::string> definitions = DefinitionsIn(database);
  std::map<std::int64_t, MessageTaker> topics;
  SQLite::Statement rows(database, "SELECT id, name, type FROM topics");
  while (rows.executeStep()) {
    const std::string name = rows.getColumn(1).getString();
    const std::string type = rows.getColumn(2).getString();
    if (auto take = recording.Open({name, type, definitions[type]})) {
      topics.emplace(rows.getColumn(0).getInt64(), std::move(take));
    }
  }
  return topics;
}

/// Views that take the place of tables may give rows without end.
std::optional<Refusal> LacksTable(const SQLite::Database& database, const fs::path& file) {
  for (const char* table : {"topics", "messages"}) {
    if (database.tableExists(table)) continue;
    return Refusal{file.string(),
                   std::string("cannot be read as a rosbag2 database: it has no table ") + table,
                   "give a .db3 file that ros2 bag wrote"};
  }
  return std::nullopt;
}

double MessagesIn(const SQLite::Database& database) {
  SQLite::Statement count(database, "SELECT COUNT(*) FROM messages");
  count.executeStep();
  return count.getColumn(0).getDouble();
}

std::optional<Refusal> TakeDatabase(const fs::path& file, RosIntake& recording,
                                    const ReadProgress& progress) {
  try {
    const SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
    if (auto refusal = LacksTable(database, file)) return refusal;
    const std::map<std::int64_t, MessageTaker> topics = TopicsIn(database, recording);
    SQLite::Statement rows(database,
                           "SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp");
    const double messages = MessagesIn(database);
    for (double read = 1.0; rows.executeStep(); ++read) {
      if (progress) progress(read / messages);
      const auto topic = topics.find(rows.getColumn(0).getInt64());
      if (topic == topics.end()) continue;
      const SQLite::Column data = rows.getColumn(2);
      topic->second(rows.getColumn(1).getInt64(), {static_cast<const std::uint8_t*>(data.getBlob()),
                                                   static_cast<std::size_t>(data.getBytes())});
    }
  } catch (const SQLite::Exception& error) {
    return Refusal{file.string(),
                   std::string("cannot be read as a rosbag2 database: ") + error.what(),
                   "give a .db3 file that ros2 bag wrote"};
  }
  return std::nullopt;
}

/// The messages of one file, which is no compressed database; returns its damage.
Result<std::string> TakeFile(const fs::path& file, RosIntake& recording,
                             const ReadProgress& progress) {
  if (!HoldsMcap(BeginningOf(file))) {
    if (auto refusal = TakeDatabase(file, recording, progress))
      return tl::unexpected(*std::move(refusal));
    return std::string();
  }
  const auto open = [&](const McapChannel& channel) -> MessageTaker {
    if (channel.encoding == "cdr") {
      return recording.Open({channel.topic, channel.schema, channel.definition});
    }
    recording.Leave(channel.topic, channel.encoding);
    return nullptr;
  };
  const McapVisitor visitor{open, progress};
  return ForEachMcapMessage(file, visitor).map([](const McapDamage& damage) {
    return damage.Summary();
  });
}

/// The same of a file that may be compressed.
Result<std::string> TakeAnyFile(const fs::path& file, RosIntake& recording,
                                const ReadProgress& progress) {
  const std::vector<std::uint8_t> beginning = BeginningOf(file);
  if (!BeginsLikeZstdFrame(beginning) || HoldsMcap(beginning)) {
    return TakeFile(file, recording, progress);
  }
  const TemporaryFile inflated;
  const auto is_whole = InflateZstdFile(file, inflated.Path());
  if (!is_whole) return tl::unexpected(is_whole.error());
  auto damage = TakeFile(inflated.Path(), recording, progress);
  if (!damage) {
    damage.error().subject = file.string() + (*is_whole ? "" : ", which is cut off,");
  } else if (!*is_whole) {
    *damage += "; " + file.filename().string() + " is cut off";
  }
  return damage;
}

}  // namespace

bool IsRosbag2Folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) && !FilesOf(path).empty();
}

Result<SourceLog> ReadRosbag2(const fs::path& path, const SourceOptions& options) {
  if (auto refusal = options.Validate()) return tl::unexpected(*std::move(refusal));
  RosIntake recording(options);
  std::string damage;
  const std::vector<fs::path> files = FilesOf(path);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ReadProgress progress = [&](double share) {
      if (options.progress) {
        options.progress((static_cast<double>(i) + share) / static_cast<double>(files.size()));
      }
    };
    auto taken = TakeAnyFile(files[i], recording, progress);
    if (!taken) return tl::unexpected(std::move(taken).error());
    damage += *taken;
  }
  SourceLog log = std::move(recording).Finish();
  log.summary += damage;
  return log;
}

}  // namespace telltale
