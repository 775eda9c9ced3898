#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/data/samples.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// The windows of the fleet in the storage, in compressed chunks with checksums. Throws
/// DatabaseError where the database refuses. Not thread safe.
class WindowStore {
 public:
  struct Chunk {
    std::string vehicle_id;
    Recording samples;
  };

  explicit WindowStore(const Storage& storage);

  /// What messages call the database.
  const std::string& name() const { return database_->name(); }

  struct Limits {
    double duration_s = 0.0;       ///< before the newest sample, by the vehicle's clock
    std::int64_t most_chunks = 0;  ///< of a vehicle; where its clock goes back, this bounds them
  };

  /// Chunks of vehicles of one group are best saved together. Where writes need leases, a group is
  /// a slice: who renews its lease waits for the chunks of few boats.
  int GroupOf(std::string_view vehicle_id) const {
    return storage_.held() == nullptr ? 0 : SliceOf(vehicle_id);
  }

  /// Saves the chunks in one transaction, and drops of these vehicles what is beyond the limits.
  /// Passes over vehicles that another daemon serves now.
  void Save(const std::vector<Chunk>& chunks, const Limits& limits);

  /// Hands each chunk of a vehicle to `take`, oldest first. Returns how many cannot be read.
  std::size_t Load(const std::string& vehicle_id,
                   const std::function<void(const Recording&)>& take) const;

 private:
  void Insert(const Chunk& chunk, const Limits& limits);

  Storage storage_;
  std::unique_ptr<Database> database_;
};

}  // namespace telltale
