#pragma once

#include <string>
#include <vector>

#include "server/http/message.h"

namespace lacuna {

/// Refuses requests that a page of another site could make a browser send (CSRF, DNS rebinding).
class Guard {
 public:
  /// `bind`: the address that the service listens on; `hosts`: its further names, NAME (at any
  /// port) or NAME:PORT. Throws std::invalid_argument for an invalid name.
  Guard(const std::string& bind, const std::vector<std::string>& hosts);

  /// Throws HttpError 403 for a Host that is not a name of this service (DNS rebinding), and for an
  /// unsafe method from another Origin; 400 without Host.
  void check(const Request& request) const;
  /// For an unsafe request with a browser's cookie: throws HttpError 403 unless its headers say
  /// that it comes from a page of this service.
  void check_own_page(const Request& request) const;

 private:
  bool is_own(const std::string& host) const;

  std::vector<std::string> names_;       ///< at any port; all in lower case
  std::vector<std::string> with_ports_;  ///< NAME:PORT
};

/// GET and HEAD change nothing.
bool is_safe(const Request& request);

/// Throws HttpError for requests that the HTTP library would accept and misread: 400 if the headers
/// are ambiguous about the end of the body, 415 for a body that it would decompress or split.
void check_framing(const Request& request);

}  // namespace lacuna
