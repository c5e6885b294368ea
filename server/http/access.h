#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/guard.h"
#include "server/http/message.h"
#include "server/http/router.h"
#include "server/http/token.h"
#include "server/settings/http_settings.h"

namespace lacuna {

/// Access control. Without a token file, every client that reaches the address is admitted, except
/// pages of other sites. With one, clients must send the token, or the cookie that POST
/// /api/session issued for it; GET /health and the page's files are public.
class Access {
 public:
  /// `is_public`: whether a path is one of the page's files. Throws std::runtime_error for the
  /// token file, std::invalid_argument for a host.
  Access(const std::string& bind, const AccessSettings& settings,
         std::function<bool(const std::string& path)> is_public);

  /// Returns if the request is admitted. Throws HttpError 400, 401, 403, and 429 after too many
  /// wrong tokens.
  void admit(const Request& request);
  /// With a token file: adds the routes that begin and end a session. Must outlive `router`.
  void add_to(Router& router);

 private:
  Response begin_session(const Request& request);
  Response end_session(const Request& request);
  void check_token(std::string_view shown);

  const Guard guard_;
  const std::optional<Token> token_;
  const std::function<bool(const std::string&)> is_public_;
  Sessions sessions_;
  std::mutex mutex_;
  double tries_;  ///< wrong tokens still allowed at present
  std::chrono::steady_clock::time_point counted_ = std::chrono::steady_clock::now();
};

}  // namespace lacuna
