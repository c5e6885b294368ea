#pragma once

#include <deque>
#include <mutex>
#include <string>
#include <string_view>

#include "server/http/token.h"

namespace lacuna {

inline constexpr std::string_view session_cookie = "lacuna_session";

/// Browsers that have shown the token once: each has a random id of its own. In memory only, and
/// not too many: the oldest is forgotten. Any thread.
class Sessions {
 public:
  static constexpr std::size_t max_sessions = 64;

  /// A new session's id.
  std::string open();
  bool holds(std::string_view id) const;
  /// Nothing happens if it is not there.
  void close(std::string_view id);

 private:
  mutable std::mutex mutex_;
  std::deque<Token> ids_;
};

}  // namespace lacuna
