#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/guard.h"
#include "server/http/message.h"
#include "server/http/sessions.h"
#include "server/http/token.h"
#include "server/settings/http_settings.h"

namespace lacuna {

/// Decides who may ask for what. Without a token file: everybody who reaches the address and is no
/// page of another site. With one: who shows the token, or the cookie that POST /api/session gave
/// for it; GET /health and the page's own files are for everybody.
class Access {
 public:
  /// `is_public`: whether a path is one of the page's files. Throws std::runtime_error for the
  /// token file, std::invalid_argument for a host.
  Access(const std::string& bind, const AccessSettings& settings,
         std::function<bool(const std::string& path)> is_public);

  /// Returns if the request may go on; gives the answer if it is one about sessions. Throws
  /// HttpError 400, 401, 403, and 429 when too many wrong tokens were shown.
  std::optional<Response> admit(const Request& request);

 private:
  Response session(const Request& request);
  void check_token(std::string_view shown);

  const Guard guard_;
  const std::optional<Token> token_;
  const std::function<bool(const std::string&)> is_public_;
  Sessions sessions_;
  std::mutex mutex_;
  double tries_;  ///< wrong tokens that may still be shown now
  std::chrono::steady_clock::time_point counted_ = std::chrono::steady_clock::now();
};

}  // namespace lacuna
