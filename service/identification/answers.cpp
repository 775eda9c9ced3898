#include "identification/answers.hpp"

#include <spdlog/spdlog.h>

#include "codec/wire.hpp"

namespace telltale {

Answers::Answers(const Participant& participant)
    : progress_writer_(participant), reply_writer_(participant) {}

void Answers::Send(const IdentifyProgress& progress) {
  progress_writer_.Write(Encode(progress));
}

void Answers::Send(const IdentifyReply& reply) {
  if (!reply_writer_.Write(Encode(reply))) {
    spdlog::warn("a stalled client held up the reply to {}", reply.correlation_id);
  }
}

}  // namespace telltale
