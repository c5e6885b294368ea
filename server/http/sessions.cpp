#include "server/http/sessions.h"

#include <utility>

namespace lacuna {

std::string Sessions::open() {
  std::string id = random_secret();
  const std::lock_guard lock(mutex_);
  if (ids_.size() == max_sessions) ids_.pop_front();
  ids_.emplace_back(id);
  return id;
}

bool Sessions::holds(std::string_view id) const {
  const std::lock_guard lock(mutex_);
  bool found = false;
  for (const Token& t : ids_) found = t.is(id) || found;
  return found;
}

void Sessions::close(std::string_view id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(ids_, [&](const Token& t) { return t.is(id); });
}

}  // namespace lacuna
