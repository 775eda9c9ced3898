#pragma once

#include <memory>
#include <set>
#include <string>

#include "telltale/service/storage/held_slices.hpp"
#include "telltale/service/storage/storage.hpp"

namespace telltale {

/// The leases of this daemon in the database. A slice is held by whoever has its newest lease until
/// that runs out, by the clock of the database. Each new lease has a greater fence, and a row of
/// its own in the table `leases`, which stays as a record for a week after it has run out. So long
/// a daemon is remembered that is gone. Throws DatabaseError. Not thread safe.
class SliceLeases {
 public:
  /// `owner` names this daemon and no other that runs. What it held before it began is released.
  SliceLeases(const Storage& storage, std::string owner, double lease_s);
  SliceLeases(const SliceLeases&) = delete;
  SliceLeases& operator=(const SliceLeases&) = delete;
  ~SliceLeases();  ///< releases every slice, where the database can be reached

  double lease_s() const { return lease_s_; }

  /// Prolongs the leases of this daemon that have not run out, and returns them.
  Slices Renew();

  /// Takes up to `most` slices that nobody holds, and returns their new leases.
  Slices Claim(int most);

  /// Gives these slices up, so that others may take them at once.
  void Release(const std::set<int>& slices);

  /// How many daemons have renewed within a lease, this one included.
  int LiveDaemons();

  /// Who holds slices and is another; empty where nobody is.
  std::string OtherOwner();

 private:
  void ReleaseAll();
  void Record();
  void ForgetWhatIsLongGone();

  std::unique_ptr<Database> database_;
  const std::string owner_;
  const double lease_s_;
};

}  // namespace telltale
