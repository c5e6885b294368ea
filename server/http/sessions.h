#pragma once

#include <deque>
#include <mutex>
#include <string>
#include <string_view>

#include "server/http/token.h"

namespace lacuna {

inline constexpr std::string_view session_cookie = "lacuna_session";

/// Sessions of browsers that have sent the token once, each with a random id. In memory only, with
/// a limit: the oldest is dropped. Thread-safe.
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
