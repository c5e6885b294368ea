#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "server/settings.h"

namespace lacuna {

/// What the command line says; paths that are empty take their defaults.
struct ServiceSettings {
  HttpSettings http;
  AccessSettings access;
  QueueSettings queue;
  CareSettings care;
  bool uploads = false;  ///< scenes may be put
  bool verbose = false;  ///< every request is logged
  double grace_seconds = 10;
  ChildLimits limits = ExecutorSettings{}.limits;  ///< of every renderer
  std::filesystem::path data, renderer, web;
  std::vector<std::filesystem::path> scenes;
};

/// "lacuna-server 0.1.0"
std::string service_version();

/// The whole service, put together.
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
