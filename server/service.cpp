#include "server/service.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <stdexcept>

#include "jobs/spec/page_tables.h"
#include "jobs/spec/version.h"
#include "server/http/access.h"
#include "server/http/address.h"
#include "server/http/http.h"
#include "server/queue/executor_local.h"
#include "server/queue/maintenance_thread.h"
#include "server/queue/queue.h"
#include "server/routes/routes.h"
#include "server/routes/scene_uploads.h"
#include "server/service_lock.h"
#include "server/slurm/executor_slurm.h"
#include "server/sweeps/sweep_keeper.h"
#include "server/tables/sweep_table.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

fs::path own_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// The page's folder: installed beside the program, or `web` of the tree that it was built in.
fs::path find_web() {
  const fs::path bin = own_folder();
  for (const fs::path& place : {bin / "../share/lacuna/web", bin / "../../../web"}) {
    if (fs::exists(place / "index.html")) return fs::canonical(place);
  }
  throw std::invalid_argument("the page is not found; name its folder with --web");
}

/// Folders in a form that holds in the children's working directory, too.
std::vector<fs::path> absolute(const std::vector<fs::path>& folders) {
  std::vector<fs::path> result;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) {
      throw std::invalid_argument(fmt::format("{} is no folder of scenes", folder.string()));
    }
    result.push_back(fs::absolute(folder));
  }
  return result;
}

fs::path renderer(const ServiceSettings& settings) {
  return settings.renderer.empty() ? own_folder() / "lacuna" : fs::absolute(settings.renderer);
}

/// Where uploaded scenes lie: the last of the scenes roots, so that they hide no other.
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

std::unique_ptr<Executor> make_executor(const ServiceSettings& settings, const DataRoot& data,
                                        const ScenesRoots& scenes) {
  ExecutorSettings common{.renderer = renderer(settings),
                          .data = data.dir,
                          .cache = data.cache(),
                          .scenes = scenes.roots(),
                          .grace = grace(settings),
                          .limits = settings.limits};
  if (settings.executor == ExecutorKind::local) {
    return std::make_unique<LocalExecutor>(std::move(common));
  }
  return std::make_unique<SlurmExecutor>(std::move(common), settings.slurm);
}

DataRoot data_root(const ServiceSettings& settings) {
  DataRoot data =
      settings.data.empty() ? DataRoot::from_environment() : DataRoot::at(settings.data);
  fs::create_directories(data.jobs());
  return data;
}

void check(const ServiceSettings& settings) {
  if (!is_loopback(settings.http.bind) && settings.access.token_file.empty()) {
    throw std::invalid_argument(fmt::format(
        "{} can be reached from other machines, where everybody could use the service: name a "
        "--token-file, or bind to 127.0.0.1 or ::1 and tunnel to it",
        settings.http.bind));
  }
}

/// Connections need descriptors: what was allowed at the start is often too little. Gives the
/// highest that a connection may have: those above, at most half, are for the files of renderers,
/// jobs and answers.
int allow_descriptors(const ServiceSettings& settings) {
  constexpr rlim_t wanted = 8192;
  constexpr int for_answers = 512, for_a_renderer = 8;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return HttpSettings{}.max_connection_fd;
  if (limit.rlim_cur < wanted) {
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    if (::setrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur < wanted) {
      log::warn("only {} files may be open at a time: less than {} clients can be served at once",
                limit.rlim_cur, wanted);
    }
  }
  const int all = static_cast<int>(std::min<rlim_t>(limit.rlim_cur, 1 << 20));
  return all - std::min(all / 2, for_answers + for_a_renderer * settings.queue.children);
}

HttpSettings http_settings(const ServiceSettings& settings) {
  HttpSettings http = settings.http;
  http.max_connection_fd = allow_descriptors(settings);
  return http;
}

QueueSettings queue_settings(const ServiceSettings& settings) {
  QueueSettings queue = settings.queue;
  queue.grace = grace(settings);
  return queue;
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
        lock(data.dir),
        uploads(make_uploads(settings, data)),
        scenes(scenes_roots(settings, data)),
        executor(make_executor(settings, data, scenes)),
        sweeps(data),
        table(data, sweeps),
        disk(data.jobs(), settings.care.disk_floor),
        queue(*executor, table, disk, queue_settings(settings)),
        keeper(sweeps, table, queue, disk, settings.queue.max_waiting / 2),
        maintenance(table, queue, settings.care, [this] { look_at_lock(); }),
        files(page(settings)),
        access(settings.http.bind, settings.access,
               [this](const std::string& path) { return files.has(path); }),
        routes({settings, data, scenes, table, disk, queue, http_metrics, uploads.get()},
               {table, queue, sweeps, keeper}, files),
        http(http_settings(settings), routes.router(), http_metrics,
             [this](const Request& request) { return access.admit(request); }) {
    http.bind();
  }

  /// Ends the service, as a signal from outside does, if the folder is another's.
  void look_at_lock() {
    if (!lost.empty()) return;
    lost = lock.look();
    if (!lost.empty()) ::kill(::getpid(), SIGTERM);
  }

  const ServiceSettings settings;
  const DataRoot data;
  ServiceLock lock;
  const std::unique_ptr<SceneUploads> uploads;
  const ScenesRoots scenes;
  const std::unique_ptr<Executor> executor;
  SweepTable sweeps;
  JobTable table;
  DiskWatch disk;
  Queue queue;
  SweepKeeper keeper;
  MaintenanceThread maintenance;
  const StaticFiles files;
  std::string lost;  ///< why it has to end; the maintenance thread's, until that has ended
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
  parts_->sweeps.read();
  parts_->table.rescan();
  parts_->maintenance.start();
  parts_->queue.start();
  parts_->keeper.start();
  parts_->http.start();
}

void Service::stop() {
  if (parts_->uploads) parts_->uploads->stop();
  parts_->http.stop();
  parts_->keeper.stop();
  parts_->queue.stop();
  parts_->maintenance.stop();
  try {
    parts_->table.save_index();
  } catch (const std::exception& error) {
    log::warn("the next start reads every folder: {}", error.what());
  }
}

std::string Service::lost() const { return parts_->lost; }

std::string Service::url() const { return parts_->http.url(); }

}  // namespace lacuna
