#pragma once

#include <memory>
#include <string>

#include "server/settings/service_settings.h"

namespace lacuna {

/// "lacuna-server 0.1.0"
std::string service_version();

/// The whole service.
class Service {
 public:
  /// Throws std::exception with a message for people: an address beyond loopback, a data folder in
  /// use by another service, a missing renderer or page.
  explicit Service(const ServiceSettings& settings);
  ~Service();

  /// Continues the existing jobs, and listens.
  void start();
  /// Refuses new requests and lets every renderer write its checkpoint.
  void stop();
  std::string url() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lacuna
