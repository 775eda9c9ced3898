#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/client/recording/message_taker.hpp"
#include "telltale/client/recording/ros/cdr_reader.hpp"
#include "telltale/client/recording/ros/ros_channel.hpp"
#include "telltale/client/recording/ros/ros_topic.hpp"
#include "telltale/client/recording/source_log.hpp"
#include "telltale/client/recording/thruster_sides.hpp"

namespace telltale {

/// Gathers messages of ROS 2 topics; which topics count is chosen once all are read. Memory: 24 to
/// 32 bytes a sample, as far as SampleMemory goes.
///
/// Position: the topic of positions of the best type (NavSatFix, GeoPoseStamped, Odometry), of
/// several the one with most fixes. Heading: a compass, else the topic of
/// orientations of the best type (Imu, GeoPoseStamped, QuaternionStamped, Odometry). Outputs:
/// RCOut, channels 1 and 3 unless told otherwise; else heron_msgs/msg/Drive; else one topic each
/// side. Headings and outputs of the positions' namespace come first. RosTopic says what these are.
/// Clock: header stamps where the sources have them and they agree with the times of recording to a
/// second; else the times of recording.
class RosRecording {
 public:
  /// Requires: options.Validate() is empty.
  explicit RosRecording(const SourceOptions& options)
      : channels_(options), memory_(options.memory_bytes) {}

  /// Who takes the messages of a topic, for as long as this stays where it is. Definitions are not
  /// looked at: types are known by their names.
  MessageTaker Open(const RosChannel& channel,
                    CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  /// Gives the samples away, so that they stand in memory once.
  SourceLog Finish() &&;

 private:
  /// What the messages of a topic say, at the times of their headers where they have them.
  struct Topic : SampleRows {
    Topic(SampleMemory& memory, RosTopic topic) : SampleRows(memory), source(std::move(topic)) {}

    bool IsEmpty() const { return received_s.empty(); }
    void Take(double at_s, const RosReading& reading, const RosOutputChannels& channels);
    /// Whether the times of the headers are those of recording, to a second; without headers they
    /// are.
    bool StampsAgree() const;
    double StampOf(std::size_t i) const;
    /// Gives all samples the times of recording.
    void TimeByRecording();

    RosTopic source;
    std::uint64_t messages = 0;
    std::vector<double> received_s;  ///< of each sample below
    std::vector<GnssFix> fixes;
    std::vector<HeadingSample> headings;
    std::vector<ThrusterSample> commands;  ///< of kOutputs and kDrive
    std::vector<SideCommand> told;         ///< of kSide: what the thruster was told, in its unit
    std::uint64_t without_channels = 0;    ///< messages of kOutputs with too few of them

   private:
    std::size_t BytesOfRow() const;
    std::size_t Rows() const override { return received_s.size(); }
    std::size_t Bytes() const override { return Rows() * BytesOfRow(); }
    double TimeOf(std::size_t row) const override { return received_s[row]; }
    void KeepOnly(const std::vector<bool>& is_kept) override;
  };
  using Named = std::pair<const std::string, Topic>;

  /// A topic's rank for what is sought: the lower the better; nothing: it has none of it.
  using RankOf = std::function<std::optional<int>(const RosTopic&)>;
  static RankOf OfKind(RosKind kind);
  static RankOf OfSide(bool is_port);

  /// Of topics of one rank, the one whose name shares most of its beginning with `beside`: a
  /// recording of several boats has a namespace for each. Of these the one with most samples.
  Named* Best(const RankOf& rank_of, std::string_view beside = {});
  /// The topics that the channels are read from; a channel that no topic has is null.
  struct Sources {
    Named* position = nullptr;
    Named* heading = nullptr;
    Named* outputs = nullptr;
    Named* drive = nullptr;
    Named* port = nullptr;
    Named* starboard = nullptr;
  };
  Sources BestSources();
  /// Why the best topic was taken, where there are others.
  std::string Why(const RankOf& rank_of, const char* reason) const;
  std::string TakePositions(Named& from, SourceLog& log) const;
  std::string TakeHeadings(Named& from, SourceLog& log) const;
  std::string TakeSides(Named& port, Named& starboard, SourceLog& log) const;
  std::string TakeCommands(const Sources& best, SourceLog& log) const;
  std::string Contents() const;
  static std::string AgreeOnClock(const Sources& best);
  static std::string RateWarnings(const Sources& best, const SourceLog& log);
  std::string Faults() const;

  RosOutputChannels channels_;
  SampleMemory memory_;
  std::map<std::string, Topic, std::less<>> topics_;
};

}  // namespace telltale
