#pragma once

#include <filesystem>
#include <vector>

#include "jobs/queue/queue_settings.h"
#include "jobs/slurm/slurm_settings.h"
#include "server/settings/care_settings.h"
#include "server/settings/http_settings.h"

namespace lacuna {

enum class ExecutorKind { local, slurm };

/// The settings of the command line; empty paths mean their defaults.
struct ServiceSettings {
  HttpSettings http;
  AccessSettings access;
  QueueSettings queue;
  CareSettings care;
  bool uploads = false;  ///< accepts PUT of scenes
  bool import = false;   ///< rebuilds the database from the folders
  bool verbose = false;  ///< logs every request
  double grace_seconds = 10;
  ExecutorKind executor = ExecutorKind::local;
  SlurmSettings slurm;
  ChildLimits limits = ExecutorSettings{}.limits;  ///< of every renderer
  std::filesystem::path data, renderer, web;
  std::vector<std::filesystem::path> scenes;
};

}  // namespace lacuna
