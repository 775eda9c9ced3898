#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "by_kind.hpp"
#include "insist.hpp"
#include "telltale/idl/codec/checksum.hpp"
#include "telltale/idl/codec/stored_request.hpp"
#include "telltale/service/storage/packed_blob.hpp"
#include "telltale/service/windows/window_chunk.hpp"
#include "telltale/service/workers/heavy_job_codec.hpp"

namespace telltale {
namespace {

/// A blob whose checksum holds, whatever it holds.
std::string WithChecksum(std::string_view bytes) {
  const std::uint32_t sum = ChecksumOf(bytes);
  std::string blob;
  for (int shift = 0; shift < 32; shift += 8) blob += static_cast<char>(sum >> shift);
  return blob.append(bytes);
}

void InsistOnChunk(std::string_view blob) {
  const auto recording = UnpackChunk(blob);
  if (!recording) return;
  const std::string packed = PackChunk(*recording);
  const auto again = UnpackChunk(packed);
  Insist(again && PackChunk(*again) == packed);
}

void InsistOnTask(std::string_view blob) {
  const auto task = UnpackTask(blob);
  if (!task) return Insist(!task.error().Message().empty());
  const std::string packed = std::visit([](const auto& kind) { return PackTask(kind); }, *task);
  const auto again = UnpackTask(packed);
  Insist(again.has_value());
  Insist(std::visit([](const auto& kind) { return PackTask(kind); }, *again) == packed);
}

template <class Task>
void InsistOnOutcome(std::string_view blob) {
  try {
    const auto outcome = UnpackOutcome(blob, Task());
    const std::string packed = PackOutcome(outcome);
    Insist(PackOutcome(UnpackOutcome(packed, Task())) == packed);
  } catch (const std::runtime_error&) {
    // It says what is wrong.
  }
}

void InsistOnRequest(std::string_view bytes) {
  constexpr double kNow = 1e9;
  const auto request = ParseStoredRequest(bytes, kNow);
  if (!request) return Insist(!request.error().Message().empty());
  const std::string written = SerialiseRequest(*request, kNow);
  Insist(ParseStoredRequest(written, kNow).has_value());
}

void Run(std::uint8_t kind, Bytes input) {
  const std::string_view bytes = TextOf(input);
  switch (kind % 6) {
    case 0: return InsistOnChunk(PackBlob(bytes));
    case 1: return InsistOnChunk(WithChecksum(bytes));  // what zstd does not unpack
    case 2: return InsistOnTask(PackBlob(bytes));
    case 3: return InsistOnOutcome<IdentificationTask>(PackBlob(bytes));
    case 4: return InsistOnOutcome<DiagnosisTask>(PackBlob(bytes));
    default: return InsistOnRequest(bytes);
  }
}

}  // namespace
}  // namespace telltale

/// Whatever a database holds is read to something that is written and read back, or refused. The
/// first byte says as what the others are stored. Models and reports are codec_fuzz's.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return telltale::InsistByKind(data, size, telltale::Run);
}
