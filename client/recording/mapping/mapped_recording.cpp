#include "telltale/client/recording/mapping/mapped_recording.hpp"

#include <utility>

namespace telltale {

MappedRecording::MappedRecording(const Mapping& mapping)
    : samples_(
          mapping,
          {.fix = [this](const GnssFix& fix) { fixes_.push_back(fix); },
           .heading = [this](const HeadingSample& one) { headings_.push_back(one); },
           .command =
               [this](Side side, const SideCommand& command) {
                 (side == Side::kPort ? port_commands_ : starboard_commands_).push_back(command);
               }}) {}

SourceLog MappedRecording::Finish(const char* what) && {
  SourceLog log;
  log.gnss = std::move(fixes_);
  log.heading = std::move(headings_);
  log.thrusters = JoinSides(port_commands_, starboard_commands_);
  log.summary = samples_.Summary(what);
  return log;
}

}  // namespace telltale
