#pragma once

#include <string>
#include <vector>

#include "server/http/message.h"

namespace lacuna {

/// Refuses requests that a page of another site could make a browser send (CSRF, DNS rebinding).
class Guard {
 public:
  /// `bind`: the address that the service listens on; `hosts`: further names of it, NAME (at any
  /// port) or NAME:PORT. Throws std::invalid_argument for a name that is none.
  Guard(const std::string& bind, const std::vector<std::string>& hosts);

  /// Throws HttpError 403 for a Host that is no name of this service (DNS rebinding), and for an
  /// unsafe method from another Origin; 400 without Host.
  void check(const Request& request) const;
  /// For an unsafe request that a browser sent a cookie with: throws HttpError 403 unless the
  /// browser says that it comes from a page of this service.
  void check_own_page(const Request& request) const;

 private:
  bool is_own(const std::string& host) const;

  std::vector<std::string> names_;       ///< at any port; lower case, as the rest
  std::vector<std::string> with_ports_;  ///< NAME:PORT
};

/// GET and HEAD change nothing.
bool is_safe(const Request& request);

/// Throws HttpError for what the HTTP library would let pass and then misread: 400 where the
/// headers leave a doubt about where the body ends, 415 for a body that it would unpack or take
/// apart.
void check_framing(const Request& request);

}  // namespace lacuna
