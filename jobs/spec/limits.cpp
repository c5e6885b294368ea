#include "jobs/spec/limits.h"

#include <fmt/format.h>

namespace lacuna {

std::string meaning_text(const Field& field) {
  if (field.published.empty()) return std::string(field.doc);
  return fmt::format("{}; as published: `{}`", field.doc, field.published);
}

}  // namespace lacuna
