#include "telltale/service/web/process_usage.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace telltale {
namespace {

double SecondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// /proc/self/statm counts pages: all, then the resident ones.
std::uint64_t ResidentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t all = 0;
  std::uint64_t resident = 0;
  if (!(statm >> all >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t OpenDescriptors() {
  std::error_code fault;
  const std::filesystem::directory_iterator descriptors("/proc/self/fd", fault);
  if (fault) return 0;
  return static_cast<std::uint64_t>(std::distance(begin(descriptors), end(descriptors)));
}

}  // namespace

ProcessUsage ReadProcessUsage() {
  ProcessUsage usage;
  rusage times{};
  if (getrusage(RUSAGE_SELF, &times) == 0) {
    usage.cpu_s = SecondsOf(times.ru_utime) + SecondsOf(times.ru_stime);
  }
  usage.resident_bytes = ResidentBytes();
  usage.open_descriptors = OpenDescriptors();
  return usage;
}

}  // namespace telltale
