#pragma once

#include <cstdint>
#include <memory>

#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// The latest term that this daemon has served for or followed, on disk. A daemon that starts again
/// knows by it whether it or another has the later models. Not thread safe.
class TermStore {
 public:
  /// Throws DatabaseError where the database cannot be opened.
  explicit TermStore(const Storage& storage);

  /// 0: none yet.
  std::uint32_t Latest() const;

  /// It is on disk on return. Throws DatabaseError.
  void Keep(std::uint32_t term);

 private:
  std::unique_ptr<Database> database_;
};

}  // namespace telltale
