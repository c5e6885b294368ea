#include "server/service.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "base/log/log.h"
#include "jobs/queue/executor_local.h"
#include "jobs/queue/import_folders.h"
#include "jobs/queue/queue.h"
#include "jobs/slurm/executor_slurm.h"
#include "jobs/spec/page_tables.h"
#include "jobs/spec/version.h"
#include "server/http/access.h"
#include "server/http/address.h"
#include "server/http/http.h"
#include "server/keeper/maintenance_thread.h"
#include "server/keeper/sweep_folders.h"
#include "server/keeper/sweep_keeper.h"
#include "server/routes/routes.h"
#include "server/routes/scene_uploads.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

fs::path own_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// The page's folder: installed beside the program, or `web` in the source tree.
fs::path find_web() {
  const fs::path bin = own_folder();
  for (const fs::path& place : {bin / "../share/lacuna/web", bin / "../../../web"}) {
    if (fs::exists(place / "index.html")) return fs::canonical(place);
  }
  throw std::invalid_argument("the page is not found; set its folder with --web");
}

/// Absolute paths, which are valid in the children's working directory, too.
std::vector<fs::path> absolute(const std::vector<fs::path>& folders) {
  std::vector<fs::path> result;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) {
      throw std::invalid_argument(fmt::format("{} is not a folder of scenes", folder.string()));
    }
    result.push_back(fs::absolute(folder));
  }
  return result;
}

fs::path renderer(const ServiceSettings& settings) {
  return settings.renderer.empty() ? own_folder() / "lacuna" : fs::absolute(settings.renderer);
}

/// The folder of uploaded scenes: the last of the scenes roots, so that they hide no other scene.
fs::path uploads_folder(const DataRoot& data) { return data.dir / "scenes"; }

std::vector<fs::path> given_roots(const ServiceSettings& settings) {
  return absolute(settings.scenes.empty() ? ScenesRoots::from_environment().roots()
                                          : settings.scenes);
}

std::unique_ptr<SceneUploads> make_uploads(const ServiceSettings& settings, const DataRoot& data) {
  if (!settings.uploads) return nullptr;
  return std::make_unique<SceneUploads>(SceneUploadSettings{.folder = uploads_folder(data),
                                                            .older = given_roots(settings),
                                                            .renderer = renderer(settings),
                                                            .limits = settings.limits});
}

ScenesRoots scenes_roots(const ServiceSettings& settings, const DataRoot& data) {
  auto roots = given_roots(settings);
  if (settings.uploads) roots.push_back(uploads_folder(data));
  return ScenesRoots(std::move(roots));
}

std::chrono::milliseconds grace(const ServiceSettings& settings) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * settings.grace_seconds));
}

ExecutorSettings executor_settings(const ServiceSettings& settings, const DataRoot& data,
                                   const ScenesRoots& scenes) {
  return {.renderer = renderer(settings),
          .directory = data.dir,
          .data = data.dir,
          .cache = data.cache(),
          .scenes = scenes.roots(),
          .grace = grace(settings),
          .limits = settings.limits};
}

std::unique_ptr<Executor> make_executor(const ServiceSettings& settings, const DataRoot& data,
                                        const ScenesRoots& scenes) {
  ExecutorSettings common = executor_settings(settings, data, scenes);
  if (settings.executor == ExecutorKind::local) {
    return std::make_unique<LocalExecutor>(std::move(common));
  }
  return std::make_unique<SlurmExecutor>(std::move(common), settings.slurm);
}

DataRoot data_root(const ServiceSettings& settings) {
  DataRoot data =
      settings.data.empty() ? DataRoot::from_environment() : DataRoot::at(settings.data);
  fs::create_directories(data.jobs());
  fs::create_directories(data.sweeps());
  return data;
}

void check(const ServiceSettings& settings) {
  if (!is_loopback(settings.http.bind) && settings.access.token_file.empty()) {
    throw std::invalid_argument(
        fmt::format("other machines can reach {}, so anyone there could use the service: set a "
                    "--token-file, or bind to 127.0.0.1 or ::1 and tunnel to it",
                    settings.http.bind));
  }
}

/// Raises the limit of open files to its maximum. A quarter of them is for connections, a quarter
/// for the files that these send, and half for the service and its renderers.
HttpSettings http_settings(const ServiceSettings& settings) {
  constexpr rlim_t wanted = 8192;
  HttpSettings http = settings.http;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return http;
  if (limit.rlim_cur < wanted) {
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    ::setrlimit(RLIMIT_NOFILE, &limit);
    ::getrlimit(RLIMIT_NOFILE, &limit);
  }
  if (limit.rlim_cur < 4 * http.threads) {
    http.threads = std::max<std::size_t>(1, limit.rlim_cur / 4);
    log::warn("only {} files may be open at a time: at most {} clients can be connected",
              limit.rlim_cur, http.threads);
  }
  return http;
}

QueueSettings queue_settings(const ServiceSettings& settings) {
  QueueSettings queue = settings.queue;
  queue.grace = grace(settings);
  return queue;
}

/// Renames a database, which keeps its content for people. Throws DatabaseInUse, std::system_error.
void put_aside(const fs::path& file) {
  try {
    const Database not_in_use(file);
  } catch (const DatabaseDamaged&) {
    // It is damaged, which is why it is renamed.
  }
  const std::string aside = file.string() + ".replaced-" + new_job_id();
  for (const char* part : {"", "-wal"}) {
    if (fs::exists(file.string() + part)) fs::rename(file.string() + part, aside + part);
  }
}

/// Opens the database of the jobs, importing existing folders into a new one. Throws
/// std::invalid_argument with advice if it cannot be used.
std::unique_ptr<Store> open_store(const ServiceSettings& settings, const DataRoot& data) {
  const fs::path file = data.dir / "lacuna.db";
  try {
    if (settings.import) put_aside(file);
    auto store = std::make_unique<Store>(file);
    const Imported taken = import_folders(*store, data);
    if (taken.jobs + taken.sweeps > 0) {
      log::info("imported {} jobs and {} sweeps from their folders", taken.jobs, taken.sweeps);
    }
    return store;
  } catch (const DatabaseDamaged& error) {
    throw std::invalid_argument(fmt::format(
        "{}; `lacuna-server --import --data {}` renames it and imports the jobs from their folders",
        error.what(), data.dir.string()));
  } catch (const DatabaseInUse&) {
    throw std::invalid_argument(
        fmt::format("another lacuna-server is using {}", data.dir.string()));
  }
}

StaticFiles page(const ServiceSettings& settings) {
  StaticFiles files(settings.web.empty() ? find_web() : fs::canonical(settings.web));
  files.add_made("/job_tables.js", page_tables_module());
  return files;
}

}  // namespace

std::string service_version() { return "lacuna-server " + version(); }

struct Service::Parts {
  explicit Parts(const ServiceSettings& given)
      : settings(given),
        data(data_root(settings)),
        store(open_store(settings, data)),
        uploads(make_uploads(settings, data)),
        scenes(scenes_roots(settings, data)),
        executor(make_executor(settings, data, scenes)),
        folders(data),
        disk(data.jobs(), settings.care.disk_floor),
        queue(*executor, *store, data.jobs(), disk, queue_settings(settings)),
        keeper(*store, folders, queue, disk, settings.queue.max_waiting / 2),
        maintenance(*store, queue, data, settings.care),
        files(page(settings)),
        access(settings.http.bind, settings.access,
               [this](const std::string& path) { return files.has(path); }),
        routes({settings, data, scenes, *store, disk, queue, http_metrics, uploads.get()},
               {*store, queue, folders, keeper}, executor_settings(settings, data, scenes), files,
               access),
        http(http_settings(settings), routes.router(), http_metrics,
             [this](const Request& request) { access.admit(request); }) {
    http.bind();
  }

  const ServiceSettings settings;
  const DataRoot data;
  const std::unique_ptr<Store> store;
  const std::unique_ptr<SceneUploads> uploads;
  const ScenesRoots scenes;
  const std::unique_ptr<Executor> executor;
  SweepFolders folders;
  DiskWatch disk;
  Queue queue;
  SweepKeeper keeper;
  MaintenanceThread maintenance;
  const StaticFiles files;
  Access access;
  HttpMetrics http_metrics;
  Routes routes;
  HttpServer http;
};

Service::Service(const ServiceSettings& settings) {
  check(settings);
  parts_ = std::make_unique<Parts>(settings);
}
Service::~Service() { stop(); }

void Service::start() {
  remove_stale_folders(parts_->data.jobs());
  remove_stale_folders(parts_->data.sweeps());
  parts_->maintenance.start();
  parts_->queue.start();
  parts_->keeper.start();
  parts_->http.start();
}

void Service::stop() {
  if (parts_->uploads) parts_->uploads->stop();
  parts_->routes.stop();
  parts_->http.stop();
  parts_->keeper.stop();
  parts_->queue.stop();
  parts_->maintenance.stop();
}

std::string Service::url() const { return parts_->http.url(); }

}  // namespace lacuna
