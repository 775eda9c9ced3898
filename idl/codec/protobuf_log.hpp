#pragma once

namespace telltale {

/// Keeps the log lines of Protobuf off standard error: codecs return their faults as CodecError.
/// Process-wide and not thread safe; call it at the start of main.
void SilenceProtobufLog();

}  // namespace telltale
