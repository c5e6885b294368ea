#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "jobs/queue/disk_watch.h"
#include "jobs/queue/queue.h"
#include "jobs/store/job_folder.h"
#include "server/http/http_metrics.h"
#include "server/http/router.h"
#include "server/routes/scene_uploads.h"
#include "server/settings/service_settings.h"

namespace lacuna {

/// The input of the routes about the service itself. All must outlive them.
struct ServiceFacts {
  const ServiceSettings& settings;
  const DataRoot& data;
  const ScenesRoots& scenes;
  const Store& store;
  const DiskWatch& disk;
  const Queue& queue;
  const HttpMetrics& http;
  SceneUploads* uploads;  ///< none: uploads are off
};

/// /health, /metrics, /openapi.json, /api/info, /api/states, /api/schema/job, /api/scenes and
/// /api/cache.
class ServiceRoutes {
 public:
  explicit ServiceRoutes(const ServiceFacts& facts) : facts_(facts) {}
  void add_to(Router& router);

 private:
  Response health() const;
  Response info() const;
  Response metrics() const;
  Response put_scene(const Request& request, const std::string& name) const;

  const ServiceFacts facts_;
  const std::string started_ = utc_now();
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace lacuna
