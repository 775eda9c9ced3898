#include "telltale/service/storage/database.hpp"

namespace telltale {

std::int64_t IntegerOf(Database& database, const std::string& statement,
                       const Parameters& parameters) {
  std::int64_t value = 0;
  database.Query(statement, parameters, [&](const Row& row) { value = row.Integer("value"); });
  return value;
}

}  // namespace telltale
