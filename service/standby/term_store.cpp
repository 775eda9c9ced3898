#include "telltale/service/standby/term_store.hpp"

#include "telltale/service/storage/stores.hpp"

namespace telltale {

TermStore::TermStore(const Storage& storage) : database_(storage.Open(TermsSchema())) {}

std::uint32_t TermStore::Latest() const {
  return static_cast<std::uint32_t>(
      IntegerOf(*database_, "SELECT COALESCE(MAX(term), 0) AS value FROM terms"));
}

void TermStore::Keep(std::uint32_t term) {
  database_->InTransaction([&] {
    database_->Execute("DELETE FROM terms");
    database_->Execute("INSERT INTO terms (term) VALUES ($1)", {std::int64_t{term}});
  });
}

}  // namespace telltale
