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
  /// Throws std::exception with a message for a person: an address that is no loopback, a data
  /// folder that another service has, a renderer or a page that is not there.
  explicit Service(const ServiceSettings& settings);
  ~Service();

  /// Takes up the jobs that are there, and listens.
  void start();
  /// Refuses new requests and lets every renderer write its checkpoint.
  void stop();
  std::string url() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lacuna
