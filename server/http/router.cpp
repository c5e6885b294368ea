#include "server/http/router.h"

namespace lacuna {

void check_query(const Query& query, const RouteDoc& doc) {
  std::vector<std::string> names;
  names.reserve(doc.query.size());
  for (const QueryParameter& p : doc.query) names.push_back(p.name);
  query.check_known(names);
  for (const QueryParameter& p : doc.query) {
    if (p.type == QueryParameter::Type::integer) query.integer(p.name, p.min, p.max);
    if (p.type == QueryParameter::Type::flag) query.flag(p.name);
  }
}

}  // namespace lacuna
