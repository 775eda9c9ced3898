#include "telltale/client/recording/mapping/mapped_recording.hpp"

#include <utility>

#include "telltale/client/recording/further_part.hpp"

namespace telltale {

MappedRecording::MappedRecording(const Mapping& mapping, std::size_t most_bytes)
    : memory_(most_bytes),
      samples_(mapping,
               {.fix = [this](const GnssFix& fix) { fixes_.Add(fix); },
                .heading = [this](const HeadingSample& one) { headings_.Add(one); },
                .command =
                    [this](Side side, const SideCommand& command) {
                      (side == Side::kPort ? port_commands_ : starboard_commands_).Add(command);
                    }}) {}

SourceLog MappedRecording::Finish(const char* what) && {
  SourceLog log;
  log.gnss = std::move(fixes_).Release();
  log.heading = std::move(headings_).Release();
  log.thrusters = JoinSides(port_commands_.Samples(), starboard_commands_.Samples());
  log.summary = samples_.Summary(what) + FurtherPart(memory_.Summary());
  return log;
}

}  // namespace telltale
