#include "telltale/service/slices/slice_leases.hpp"

#include <exception>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "telltale/service/storage/server_clock.hpp"
#include "telltale/service/storage/stores.hpp"

namespace telltale {
namespace {

Slices SlicesOf(Database& database, const std::string& statement, const Parameters& parameters) {
  Slices slices;
  database.Query(statement, parameters, [&](const Row& row) {
    slices.emplace(static_cast<int>(row.Integer("slice")), row.Integer("fence"));
  });
  return slices;
}

}  // namespace

SliceLeases::SliceLeases(const Storage& storage, std::string owner, double lease_s)
    : database_(storage.Open(SlicesSchema())), owner_(std::move(owner)), lease_s_(lease_s) {
  database_->InTransaction([&] {
    for (std::int64_t slice = 0; slice < kFleetSlices; ++slice) {
      database_->Execute(
          "INSERT INTO slices (slice, fence, owner, until_unix_s) VALUES ($1, 0, '', 0)"
          " ON CONFLICT (slice) DO NOTHING",
          {slice});
    }
  });
  ReleaseAll();  // the process that held them is dead: it was this daemon
}

SliceLeases::~SliceLeases() {
  try {
    ReleaseAll();
    database_->Execute("DELETE FROM daemons WHERE owner = $1", {owner_});
  } catch (const std::exception& error) {
    spdlog::warn("{}; the slices of this daemon are free once their leases run out", error.what());
  }
}

Slices SliceLeases::Renew() {
  Slices held;
  database_->InTransaction([&] {
    database_->Execute(fmt::format("INSERT INTO daemons (owner, until_unix_s) VALUES ($1, {} + $2)"
                                   " ON CONFLICT (owner) DO UPDATE"
                                   " SET until_unix_s = excluded.until_unix_s",
                                   kServerNow),
                       {owner_, lease_s_});
    // In their order, as writers lock them.
    database_->Query("SELECT slice FROM slices WHERE owner = $1 ORDER BY slice FOR UPDATE",
                     {owner_}, [](const Row&) {});
    held = SlicesOf(*database_,
                    fmt::format("UPDATE slices SET until_unix_s = {0} + $2"
                                " WHERE owner = $1 AND until_unix_s > {0} RETURNING slice, fence",
                                kServerNow),
                    {owner_, lease_s_});
    Record();
  });
  return held;
}

Slices SliceLeases::Claim(int most) {
  Slices claimed;
  database_->InTransaction([&] {
    // A write under the former lease that is being committed keeps its slice for now.
    claimed = SlicesOf(
        *database_,
        fmt::format("UPDATE slices SET fence = fence + 1, owner = $1, until_unix_s = {0} + $2"
                    " WHERE slice IN (SELECT slice FROM slices WHERE until_unix_s <= {0}"
                    " ORDER BY slice LIMIT $3 FOR UPDATE SKIP LOCKED) RETURNING slice, fence",
                    kServerNow),
        {owner_, lease_s_, std::int64_t{most}});
    for (const auto& [slice, fence] : claimed) {
      database_->Execute(
          fmt::format("INSERT INTO leases (slice, fence, owner, since_unix_s, until_unix_s)"
                      " SELECT slice, fence, owner, {}, until_unix_s FROM slices WHERE slice = $1",
                      kServerNow),
          {std::int64_t{slice}});
    }
    if (!claimed.empty()) ForgetWhatIsLongGone();
  });
  return claimed;
}

/// A daemon that ends without a word, or gets another name, leaves its rows behind.
void SliceLeases::ForgetWhatIsLongGone() {
  constexpr double kRecordKeptS = 7 * 86400.0;
  for (const char* table : {"leases", "daemons"}) {
    database_->Execute(
        fmt::format("DELETE FROM {} WHERE until_unix_s < {} - $1", table, kServerNow),
        {kRecordKeptS});
  }
}

void SliceLeases::Release(const std::set<int>& slices) {
  database_->InTransaction([&] {
    for (const std::int64_t slice : slices) {
      database_->Execute(fmt::format("UPDATE slices SET until_unix_s = {0}"
                                     " WHERE slice = $1 AND owner = $2 AND until_unix_s > {0}",
                                     kServerNow),
                         {slice, owner_});
    }
    Record();
  });
}

/// How long the leases of this daemon last.
void SliceLeases::Record() {
  database_->Execute(
      "UPDATE leases SET until_unix_s = slices.until_unix_s FROM slices"
      " WHERE slices.owner = $1 AND leases.slice = slices.slice AND leases.fence = slices.fence",
      {owner_});
}

void SliceLeases::ReleaseAll() {
  std::set<int> all;
  for (int slice = 0; slice < kFleetSlices; ++slice) all.insert(slice);
  Release(all);
}

/// A database that is slow to renew lets even the lease of this daemon run out, which lives.
int SliceLeases::LiveDaemons() {
  const std::int64_t others = IntegerOf(*database_,
                                        fmt::format("SELECT COUNT(*) AS value FROM daemons"
                                                    " WHERE owner <> $1 AND until_unix_s > {}",
                                                    kServerNow),
                                        {owner_});
  return 1 + static_cast<int>(others);
}

std::string SliceLeases::OtherOwner() {
  std::string owner;
  database_->Query(fmt::format("SELECT owner FROM slices WHERE owner <> $1 AND until_unix_s > {}"
                               " ORDER BY slice LIMIT 1",
                               kServerNow),
                   {owner_}, [&](const Row& row) { owner = row.Text("owner"); });
  return owner;
}

}  // namespace telltale
