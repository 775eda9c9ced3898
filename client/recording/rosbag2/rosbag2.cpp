#include "telltale/client/recording/rosbag2/rosbag2.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "telltale/client/recording/mcap/mcap_recording.hpp"
#include "telltale/client/recording/ros/ros_intake.hpp"

namespace telltale {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> FilesOf(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".db3" || extension == ".mcap") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Definitions of message types, which newer recordings hold, by type.
std::map<std::string, std::string> DefinitionsIn(const SQLite::Database& database) {
  std::map<std::string, std::string> definitions;
  if (!database.tableExists("message_definitions")) return definitions;
  SQLite::Statement rows(database,
                         "SELECT topic_type, encoded_message_definition FROM message_definitions "
                         "WHERE encoding = 'ros2msg'");
  while (rows.executeStep()) {
    definitions[rows.getColumn(0).getString()] = rows.getColumn(1).getString();
  }
  return definitions;
}

std::optional<Refusal> TakeDatabase(const fs::path& file, RosIntake& recording) {
  try {
    const SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
    std::map<std::string, std::string> definitions = DefinitionsIn(database);
    SQLite::Statement rows(database,
                           "SELECT topics.name, topics.type, messages.timestamp, messages.data "
                           "FROM messages JOIN topics ON topics.id = messages.topic_id "
                           "ORDER BY messages.timestamp");
    while (rows.executeStep()) {
      const SQLite::Column data = rows.getColumn(3);
      const std::string type = rows.getColumn(1).getString();
      recording.Take(rows.getColumn(0).getString(), type, definitions[type],
                     rows.getColumn(2).getInt64(),
                     {static_cast<const std::uint8_t*>(data.getBlob()),
                      static_cast<std::size_t>(data.getBytes())});
    }
  } catch (const SQLite::Exception& error) {
    return Refusal{file.string(),
                   std::string("cannot be read as a rosbag2 database: ") + error.what(),
                   "give a .db3 file that ros2 bag wrote, decompressed"};
  }
  return std::nullopt;
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
  for (const fs::path& file : FilesOf(path)) {
    if (file.extension() == ".mcap") {
      auto read = ForEachMcapMessage(file, [&](const McapMessage& message) {
        if (message.encoding == "cdr") {
          recording.Take(message.topic, message.schema, message.definition, message.log_time_ns,
                         message.data);
        }
      });
      if (!read) return tl::unexpected(std::move(read).error());
      damage += read->Summary();
    } else if (auto refusal = TakeDatabase(file, recording)) {
      return tl::unexpected(*std::move(refusal));
    }
  }
  SourceLog log = recording.Finish();
  log.summary += damage;
  return Complete(std::move(log), path);
}

}  // namespace telltale
