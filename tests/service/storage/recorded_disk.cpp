#include "service/storage/recorded_disk.hpp"

#include <algorithm>
#include <fstream>
#include <utility>

#include <sqlite3.h>

namespace telltale {
namespace {

constexpr std::size_t kSector = 512;
constexpr const char* kName = "recorded";

RecordedDisk* standing = nullptr;  // the one that stands

/// An open file, in memory that SQLite allots: that of the real one follows it.
struct RecordedFile {
  sqlite3_file base;
  std::string* path;

  sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

RecordedFile& Recorded(sqlite3_file* file) {
  return *reinterpret_cast<RecordedFile*>(file);
}

sqlite3_file* Real(sqlite3_file* file) {
  return Recorded(file).real();
}

int Close(sqlite3_file* file) {
  delete std::exchange(Recorded(file).path, nullptr);
  return Real(file)->pMethods->xClose(Real(file));
}

int Write(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 offset) {
  standing->Write(*Recorded(file).path,
                  {static_cast<const char*>(bytes), static_cast<std::size_t>(size)},
                  static_cast<std::size_t>(offset));
  return Real(file)->pMethods->xWrite(Real(file), bytes, size, offset);
}

int Truncate(sqlite3_file* file, sqlite3_int64 size) {
  standing->Truncate(*Recorded(file).path, static_cast<std::size_t>(size));
  return Real(file)->pMethods->xTruncate(Real(file), size);
}

int Sync(sqlite3_file* file, int flags) {
  const int result = Real(file)->pMethods->xSync(Real(file), flags);
  standing->Sync(*Recorded(file).path);
  return result;
}

/// The real file does all else. Pages are not mapped into memory: each write comes through Write().
const sqlite3_io_methods& Methods() {
  static const sqlite3_io_methods methods{
      .iVersion = 2,
      .xClose = Close,
      .xRead =
          [](sqlite3_file* file, void* bytes, int size, sqlite3_int64 offset) {
            return Real(file)->pMethods->xRead(Real(file), bytes, size, offset);
          },
      .xWrite = Write,
      .xTruncate = Truncate,
      .xSync = Sync,
      .xFileSize =
          [](sqlite3_file* file, sqlite3_int64* size) {
            return Real(file)->pMethods->xFileSize(Real(file), size);
          },
      .xLock = [](sqlite3_file* file,
                  int level) { return Real(file)->pMethods->xLock(Real(file), level); },
      .xUnlock = [](sqlite3_file* file,
                    int level) { return Real(file)->pMethods->xUnlock(Real(file), level); },
      .xCheckReservedLock =
          [](sqlite3_file* file, int* is_locked) {
            return Real(file)->pMethods->xCheckReservedLock(Real(file), is_locked);
          },
      .xFileControl =
          [](sqlite3_file* file, int operation, void* argument) {
            return Real(file)->pMethods->xFileControl(Real(file), operation, argument);
          },
      .xSectorSize =
          [](sqlite3_file* file) { return Real(file)->pMethods->xSectorSize(Real(file)); },
      .xDeviceCharacteristics =
          [](sqlite3_file* file) {
            return Real(file)->pMethods->xDeviceCharacteristics(Real(file));
          },
      .xShmMap =
          [](sqlite3_file* file, int region, int size, int extend, void volatile** memory) {
            return Real(file)->pMethods->xShmMap(Real(file), region, size, extend, memory);
          },
      .xShmLock =
          [](sqlite3_file* file, int offset, int count, int flags) {
            return Real(file)->pMethods->xShmLock(Real(file), offset, count, flags);
          },
      .xShmBarrier = [](sqlite3_file* file) { Real(file)->pMethods->xShmBarrier(Real(file)); },
      .xShmUnmap =
          [](sqlite3_file* file, int is_deleted) {
            return Real(file)->pMethods->xShmUnmap(Real(file), is_deleted);
          },
      .xFetch = nullptr,
      .xUnfetch = nullptr,
  };
  return methods;
}

int Open(sqlite3_vfs*, const char* path, sqlite3_file* file, int flags, int* flags_out) {
  RecordedFile& recorded = Recorded(file);
  recorded.base.pMethods = nullptr;
  const int result =
      standing->real().xOpen(&standing->real(), path, recorded.real(), flags, flags_out);
  if (result != SQLITE_OK) return result;
  recorded.path = new std::string(path == nullptr ? "" : path);
  recorded.base.pMethods = &Methods();
  return SQLITE_OK;
}

int Delete(sqlite3_vfs*, const char* path, int sync_folder) {
  const int result = standing->real().xDelete(&standing->real(), path, sync_folder);
  standing->Delete(path);
  if (sync_folder != 0) standing->Sync(path);
  return result;
}

/// The real file system does all else.
sqlite3_vfs& RecordingVfs() {
  static sqlite3_vfs vfs;
  vfs = standing->real();
  vfs.zName = kName;
  vfs.pNext = nullptr;
  vfs.szOsFile = static_cast<int>(sizeof(RecordedFile)) + standing->real().szOsFile;
  vfs.xOpen = Open;
  vfs.xDelete = Delete;
  return vfs;
}

}  // namespace

RecordedDisk::RecordedDisk() : real_(*sqlite3_vfs_find(nullptr)) {
  standing = this;
  sqlite3_vfs_register(&RecordingVfs(), 1);
}

RecordedDisk::~RecordedDisk() {
  sqlite3_vfs_unregister(sqlite3_vfs_find(kName));
  sqlite3_vfs_register(&real_, 1);
  standing = nullptr;
}

std::size_t RecordedDisk::Now() const {
  const std::lock_guard lock(mutex_);
  return operations_.size();
}

void RecordedDisk::Write(const std::string& file, std::string_view bytes, std::size_t offset) {
  Record({Kind::kWrite, file, std::string(bytes), offset});
}

void RecordedDisk::Truncate(const std::string& file, std::size_t size) {
  Record({Kind::kTruncate, file, "", size});
}

void RecordedDisk::Sync(const std::string& file) {
  Record({Kind::kSync, file, "", 0});
}

void RecordedDisk::Delete(const std::string& file) {
  Record({Kind::kDelete, file, "", 0});
}

void RecordedDisk::Record(Operation operation) {
  const std::lock_guard lock(mutex_);
  operations_.push_back(std::move(operation));
}

void RecordedDisk::LeaveAfterCut(std::size_t now, const std::filesystem::path& from,
                                 const std::filesystem::path& to, RandomEngine& random) const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::size_t> synced;  // by file: what is certainly on the disk
  std::size_t last_sync = 0;                  // of any file, which settles all names
  for (std::size_t i = 0; i < now; ++i) {
    if (operations_[i].kind == Kind::kSync) synced[operations_[i].file] = last_sync = i;
  }
  Files files;
  for (std::size_t i = 0; i < now; ++i) {
    const Operation& operation = operations_[i];
    const bool is_of_names = operation.kind == Kind::kDelete;
    const bool is_synced = i < (is_of_names ? last_sync : synced[operation.file]);
    is_synced ? Apply(operation, files) : ApplyInPart(operation, files, random);
  }
  std::filesystem::create_directories(to);
  for (const auto& [path, contents] : files) {
    const std::filesystem::path file(path);
    if (file.parent_path() != from) continue;
    std::ofstream(to / file.filename(), std::ios::binary) << contents;
  }
}

void RecordedDisk::Apply(const Operation& operation, Files& files) {
  const auto& [kind, file, bytes, offset] = operation;
  if (kind == Kind::kDelete) files.erase(file);
  if (kind == Kind::kTruncate) files[file].resize(offset);
  if (kind != Kind::kWrite) return;
  std::string& contents = files[file];
  contents.resize(std::max(contents.size(), offset + bytes.size()));
  contents.replace(offset, bytes.size(), bytes);
}

/// Each sector of it, or none.
void RecordedDisk::ApplyInPart(const Operation& operation, Files& files, RandomEngine& random) {
  const auto happens = [&random] { return random() % 2 == 0; };
  if (operation.kind != Kind::kWrite) {
    if (happens()) Apply(operation, files);
    return;
  }
  const std::size_t end = operation.offset + operation.bytes.size();
  for (std::size_t from = operation.offset; from < end;) {
    const std::size_t to = std::min(end, (from / kSector + 1) * kSector);
    if (happens()) {
      const std::string part = operation.bytes.substr(from - operation.offset, to - from);
      Apply({Kind::kWrite, operation.file, part, from}, files);
    }
    from = to;
  }
}

}  // namespace telltale
