#pragma once

#include "telltale/client/bus/bus_log.hpp"

namespace telltale {

/// For its lifetime standard error carries this program's own lines alone: those of Ceres and
/// Protobuf are dropped, and so are those of Cyclone DDS below an error, which reads
/// "telltale: dds: ...". One per process, made at the start of main.
class LibraryLogs {
 public:
  LibraryLogs();

 private:
  BusLog bus_log_;
};

}  // namespace telltale
