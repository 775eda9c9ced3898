#include "telltale/idl/codec/protobuf_log.hpp"

#include <google/protobuf/stubs/logging.h>

namespace telltale {

void SilenceProtobufLog() {
  google::protobuf::SetLogHandler(nullptr);
}

}  // namespace telltale
