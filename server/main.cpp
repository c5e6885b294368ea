// lacuna-server: accepts jobs over HTTP and runs renderers.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <map>
#include <stdexcept>
#include <utility>

#include "base/log/log.h"
#include "jobs/slurm/request.h"
#include "jobs/spec/byte_size.h"
#include "server/service.h"

namespace {

using namespace lacuna;

/// Throws CLI::ValidationError for an invalid number of bytes.
std::uint64_t byte_size(const char* option, const std::string& text) {
  try {
    return parse_byte_size(text);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError(option, error.what());
  }
}

/// Also throws CLI::ValidationError if no renderer could run with it.
std::uint64_t memory_limit(const std::string& text) {
  constexpr std::uint64_t least = 256 << 20;
  const std::uint64_t bytes = byte_size("--memory-limit", text);
  if (bytes == 0 || bytes >= least) return bytes;
  throw CLI::ValidationError(
      "--memory-limit",
      fmt::format("found \"{}\"; allowed: 0, or at least {}", text, byte_size_text(least)));
}

/// Throws CLI::ValidationError for an option that Lacuna sets itself.
void add_slurm_arguments(ServiceSettings& s, const std::string& text) {
  try {
    for (std::string& word : slurm_arguments(text)) s.slurm.arguments.push_back(std::move(word));
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--slurm-args", error.what());
  }
}

/// Checks options and defaults of one executor only.
void check_executor(const CLI::App& app, ServiceSettings& s) {
  if (s.executor == ExecutorKind::slurm) {
    if (app.count("--jobs") == 0) s.queue.children = slurm_jobs_at_a_time;
    return;
  }
  for (const char* option : {"--slurm-args", "--slurm-cores", "--slurm-poll"}) {
    if (app.count(option) > 0) throw CLI::ValidationError(option, "needs --executor slurm");
  }
}

void define_options(CLI::App& app, ServiceSettings& s) {
  app.set_version_flag("--version", service_version());
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.add_option("--port", s.http.port, "port to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--bind", s.http.bind,
                 "address to listen on; beyond loopback only with --token-file")
      ->capture_default_str();
  app.add_option("--token-file", s.access.token_file,
                 "file with the token that clients must send: one line of 16 to 256 characters "
                 "without %, mode 0600");
  app.add_option("--host", s.access.hosts,
                 "further NAME or NAME:PORT of this service in the Host header; may be repeated")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--verbose", s.verbose, "log every request");
  app.add_option("--data", s.data, "folder of the jobs; default: $LACUNA_DATA or lacuna-data");
  app.add_flag("--import", s.import,
               "rename a damaged DATA/lacuna.db and import the jobs and sweeps from their folders");
  app.add_option("--scenes", s.scenes,
                 "folder of scenes, may be repeated; default: $LACUNA_SCENES or jobs/scenes")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--jobs", s.queue.children,
                 "renderers at a time; with Slurm, submitted jobs at a time, default 64")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--executor", s.executor,
                 "where renderers run: local (this machine) or slurm (sbatch, with a data folder "
                 "that all nodes share)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, ExecutorKind>{
          {"local", ExecutorKind::local}, {"slurm", ExecutorKind::slurm}}))
      ->default_str("local");
  app.add_option_function<std::vector<std::string>>(
         "--slurm-args",
         [&s](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) add_slurm_arguments(s, text);
         },
         "further options of sbatch, for example \"--partition=long --account=me\"; they override "
         "those derived from a job")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--slurm-cores", s.slurm.cores,
                 "cores in Slurm for a job that sets no threads; 0: an exclusive node")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option_function<double>(
         "--slurm-poll",
         [&s](double seconds) {
           s.slurm.poll = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds));
         },
         "seconds between two calls of squeue")
      ->check(CLI::Range(0.05, 3600.0))
      ->default_str("3");
  app.add_option("--max-attempts", s.queue.max_attempts,
                 "maximum starts of a job's renderer if it crashes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--grace", s.grace_seconds,
                 "seconds between SIGTERM and SIGKILL, in which renderers write a checkpoint")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--memory-limit",
         [&s](const std::string& text) { s.limits.memory_bytes = memory_limit(text); },
         "memory limit of a renderer, for example 4G or 512M; 0: no limit")
      ->default_str("0");
  app.add_option("--nice", s.limits.niceness, "niceness of renderers")
      ->check(CLI::Range(0, 19))
      ->capture_default_str();
  app.add_option("--max-jobs", s.queue.max_waiting,
                 "limit of jobs that wait or run; further ones are refused")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--disk-floor",
         [&s](const std::string& text) { s.care.disk_floor = byte_size("--disk-floor", text); },
         "free disk space to keep, for example 1G; with less, or with few inodes, jobs wait and "
         "renderers stop; 0: no floor")
      ->default_str(byte_size_text(s.care.disk_floor));
  app.add_option(
         "--keep-jobs", s.care.keep_jobs,
         "finished jobs to keep, by their state on disk; the oldest are removed; 0: keep all")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  app.add_option("--keep-days", s.care.keep_days,
                 "remove jobs this many days after they ended; 0: keep all")
      ->check(CLI::Range(0.0, 36'500.0))
      ->capture_default_str();
  app.add_flag("--uploads", s.uploads, "accept scenes over HTTP (PUT /api/scenes/NAME.glb)");
  app.add_option("--renderer", s.renderer, "the renderer; default: lacuna beside this program");
  app.add_option("--web", s.web, "folder of the page; default: web of the source tree");
}

/// Blocks the signals that end the service in every thread, so that wait_for_end() receives them.
sigset_t block_ends() {
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGTERM);
  sigaddset(&ends, SIGINT);
  sigaddset(&ends, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &ends, nullptr);
  return ends;
}

}  // namespace

int main(int argc, char** argv) {
  ServiceSettings settings;
  CLI::App app{"Lacuna's render service: accepts jobs over HTTP and runs renderers."};
  define_options(app, settings);
  app.final_callback([&] { check_executor(app, settings); });
  CLI11_PARSE(app, argc, argv);
  log::start("lacuna-server", settings.verbose);

  // A file beyond the size limit must become an error, not the end of the service.
  std::signal(SIGXFSZ, SIG_IGN);
  const sigset_t ends = block_ends();
  try {
    Service service(settings);
    service.start();
    fmt::print("lacuna-server: listening on {}\n", service.url());
    std::fflush(stdout);
    int signal = 0;
    sigwait(&ends, &signal);
    log::info("ending (signal {})", signal);
    service.stop();
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "lacuna-server: {}\n", error.what());
    return 1;
  }
}
