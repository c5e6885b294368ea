#include "jobs/slurm/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace lacuna {
namespace {

constexpr int margin_minutes = 15;

/// Upper bound of the seconds to merge the job from its shards, several times the measurement in
/// docs/scaling.md.
double merging_seconds(const JobSpec& spec) {
  constexpr double of_shard = 0.05, of_pixel = 2e-6;
  if (spec.shards == 1 || spec.shard != 0) return 0;
  const double pixels = static_cast<double>(spec.resolution[0]) * spec.resolution[1];
  return spec.shards * (of_shard + of_pixel * pixels);
}

std::optional<int> minutes_of(const JobSpec& spec) {
  const Budget& budget = spec.budget;
  if (spec.reference == "auto") return std::nullopt;
  std::optional<double> seconds = budget.seconds;
  if (budget.cpu_seconds) {
    seconds = std::min(seconds.value_or(*budget.cpu_seconds), *budget.cpu_seconds);
  }
  if (!seconds && (budget.iterations || budget.error)) return std::nullopt;
  constexpr double share = 1.25;
  const double all = share * seconds.value_or(Budget::default_seconds) + merging_seconds(spec) +
                     60.0 * margin_minutes;
  return static_cast<int>(std::ceil(all / 60));
}

/// Likely upper bound of a renderer's memory, bytes: libraries and tables, the scene as triangles,
/// the image in film, layers, checkpoint and file, the space as voxels.
double estimated_bytes(const JobSpec& spec, const RequestBasis& basis) {
  constexpr double base = 1024.0 * (1 << 20), of_scene = 24, of_pixel = 400, of_layer = 64;
  const double pixels = static_cast<double>(spec.resolution[0]) * spec.resolution[1];
  double layers = static_cast<double>(spec.layers.size());
  const auto lengths = std::ranges::find(spec.layers, LayerRequest(ImageLayer::lengths));
  if (lengths != spec.layers.end()) layers += most_edges(spec.integrator) - 1;
  return base + of_scene * static_cast<double>(basis.scene_bytes) +
         pixels * (of_pixel + of_layer * layers);
}

std::int64_t megabytes_of(const JobSpec& spec, const RequestBasis& basis) {
  constexpr double megabyte = 1 << 20;
  // Memory that RLIMIT_DATA does not count: the program and its libraries, MB.
  constexpr std::int64_t beside_the_limit = 512;
  if (basis.memory_limit > 0) {
    return static_cast<std::int64_t>(
               std::ceil(static_cast<double>(basis.memory_limit) / megabyte)) +
           beside_the_limit;
  }
  constexpr int most_doublings = 6;
  const double factor = std::exp2(std::clamp(basis.shortages, 0, most_doublings));
  return static_cast<std::int64_t>(std::ceil(factor * estimated_bytes(spec, basis) / megabyte));
}

/// Options that Lacuna sets itself, or that would keep it from following its jobs.
constexpr std::string_view own_options[] = {
    "--array",    "--chdir",  "--clusters",  "--error",    "--help",      "--input",
    "--job-name", "--output", "--open-mode", "--parsable", "--test-only", "--usage",
    "--version",  "--wait",   "--wrap",      "--signal",   "--quiet"};
constexpr std::string_view own_letters = "aDMeiJohWVQ";

bool is_own_option(const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  if (!name.starts_with("--")) {
    return word.size() >= 2 && word[0] == '-' && own_letters.find(word[1]) != own_letters.npos;
  }
  constexpr std::size_t shortest = 5;  // sbatch accepts unambiguous prefixes
  return std::any_of(std::begin(own_options), std::end(own_options), [&](std::string_view own) {
    return own == name || (name.size() >= shortest && own.starts_with(name));
  });
}

}  // namespace

int slurm_nice(int priority) { return max_priority - priority; }

SlurmRequest slurm_request(const JobSpec& spec, const RequestBasis& basis) {
  SlurmRequest request;
  request.minutes = minutes_of(spec);
  request.megabytes = megabytes_of(spec, basis);
  request.cores = spec.threads > 0 ? spec.threads : basis.cores;
  request.own_node = spec.exclusive || request.cores == 0;
  request.nice = slurm_nice(basis.priority);
  return request;
}

std::vector<std::string> request_words(const SlurmRequest& request) {
  std::vector<std::string> words{"--nodes=1", "--ntasks=1",
                                 fmt::format("--mem={}M", request.megabytes),
                                 fmt::format("--nice={}", request.nice)};
  if (request.minutes) words.push_back(fmt::format("--time={}", *request.minutes));
  if (request.cores > 0) words.push_back(fmt::format("--cpus-per-task={}", request.cores));
  if (request.own_node) words.emplace_back("--exclusive");
  return words;
}

std::vector<std::string> slurm_arguments(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    if (is_own_option(word)) {
      throw std::invalid_argument(
          fmt::format("found \"{}\", which Lacuna sets itself or does not support; allowed: other "
                      "options of sbatch, such as --partition, --account, --time",
                      word));
    }
    words.push_back(std::move(word));
  }
  if (!words.empty() && !words.front().starts_with('-')) {
    throw std::invalid_argument(fmt::format(
        "found \"{}\"; allowed: options of sbatch, which begin with '-'", words.front()));
  }
  return words;
}

std::string slurm_path(const std::filesystem::path& path) {
  std::string pattern;
  for (const char c : path.string()) {
    if (c == '\\' || static_cast<unsigned char>(c) < 0x20) {
      throw std::invalid_argument(fmt::format(
          "{}: sbatch accepts no path with a backslash or a control character", path.string()));
    }
    pattern += c;
    if (c == '%') pattern += c;
  }
  return pattern;
}

}  // namespace lacuna
