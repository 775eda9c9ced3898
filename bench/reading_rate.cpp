// How fast recordings are read, and in how much memory:
//
//   reading_rate FILE...
//
// Prints for each file its size, the processor time of one thread, the rate, the samples and the
// largest resident memory of the process until then, less what it took before the first file.
#include <sys/resource.h>

#include <cstdio>
#include <ctime>
#include <filesystem>

#include "telltale/client/recording/load_recording.hpp"

namespace {

constexpr double kMegabyte = 1e6;

double ProcessorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / kMegabyte;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: reading_rate FILE...\n");
    return 2;
  }
  const double before = PeakMegabytes();
  for (int i = 1; i < argc; ++i) {
    const double megabytes = static_cast<double>(std::filesystem::file_size(argv[i])) / kMegabyte;
    const double start_s = ProcessorSeconds();
    const auto log = telltale::ReadLog(argv[i]);
    const double took_s = ProcessorSeconds() - start_s;
    if (!log) {
      std::fprintf(stderr, "%s %s\n", log.error().subject.c_str(), log.error().reason.c_str());
      return 1;
    }
    std::printf("%s: %.0f MB in %.2f s, %.0f MB/s, %zu samples, %.0f MB of memory\n", argv[i],
                megabytes, took_s, megabytes / took_s, log->channels.Size(),
                PeakMegabytes() - before);
  }
  return 0;
}
