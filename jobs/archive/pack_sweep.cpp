#include "jobs/archive/pack_sweep.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <set>

#include "base/storage/input_file.h"
#include "jobs/archive/tar_zstd.h"
#include "jobs/run/input_check.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/problems.h"
#include "jobs/spec/version.h"
#include "jobs/store/machine.h"
#include "jobs/sweep/answers.h"

namespace lacuna {
namespace fs = std::filesystem;
namespace {

/// Scenes and the data of references lie beside the sweep, where reproduce.sh looks for them.
constexpr const char* reproduce = R"sh(#!/bin/sh
# Renders the sweep of this archive again, below reproduced.sweep, and compares the results.
# Needs lacuna {version} in PATH: other versions may give other pictures.
set -eu
cd "$(dirname "$0")"
LACUNA_SCENES="$PWD/scenes${{LACUNA_SCENES:+:$LACUNA_SCENES}}" LACUNA_DATA="$PWD/data"
export LACUNA_SCENES LACUNA_DATA
lacuna archive --check manifest.json || echo "continuing" >&2
lacuna sweep sweep.json --out reproduced.sweep "$@"
lacuna archive --check manifest.json --against reproduced.sweep
)sh";

class Packing {
 public:
  Packing(const SweepFolder& sweep, const DataRoot& data, const ScenesRoots& scenes,
          const PackOptions& options, const fs::path& out)
      : sweep_(sweep),
        data_(data),
        options_(options),
        check_(data, scenes),
        top_(out.filename().string()),
        tar_(out) {
    for (const char* ending : {".zst", ".tar"}) {
      if (top_.ends_with(ending)) top_.resize(top_.size() - std::string_view(ending).size());
    }
  }

  PackSummary run() {
    const Answers answers = answer(sweep_);
    manifest_.metric = enum_name(answers.axes.metric);
    add(sweep_.dir() / "sweep.json", "sweep.json");
    for (std::size_t i = 0; i < answers.results.size(); ++i) add_run(i, answers.results[i]);
    if (manifest_.runs.empty()) {
      throw BadJob({{"", fmt::format("{} has no run that is done; allowed: a sweep with results",
                                     sweep_.dir().string())}});
    }
    manifest_.version = version();
    manifest_.created = utc_now();
    manifest_.processor = processor_name();
    manifest_.cores = processor_threads();
    tar_.add_text(top_ + "/manifest.json", write_document(manifest_));
    tar_.add_text(top_ + "/reproduce.sh",
                  fmt::format(fmt::runtime(reproduce), fmt::arg("version", version())), true);
    tar_.finish();
    summary_.runs = manifest_.runs.size();
    summary_.files = manifest_.files.size();
    summary_.left_out = manifest_.left_out.size();
    return summary_;
  }

 private:
  void add(const fs::path& file, const std::string& name) {
    if (!packed_.insert(name).second) return;
    ArchivedFile added = tar_.add_file(top_ + "/" + name, file);
    added.name = name;
    manifest_.files.push_back(std::move(added));
  }

  void add_run(std::size_t index, const RunResult& result) {
    const SweepRun& run = sweep_.plan().runs[index];
    if (result.state.state != State::done) {
      summary_.warnings.push_back(
          fmt::format("{} is {} and left out", run.name, enum_name(result.state.state)));
      return;
    }
    const JobFolder folder = sweep_.folder(run);
    for (const char* name :
         {"job.json", "outcome.json", "inputs.json", "curve.csv", "report.json", "image.exr"}) {
      if (!options_.pictures && name == std::string_view("image.exr")) continue;
      if (fs::exists(folder.file(name))) {
        add(folder.file(name), fmt::format("runs/{}/{}", run.name, name));
      }
    }
    manifest_.runs.push_back({run.name, run.cell + 1, result.seconds, result.cpu_seconds,
                              result.end ? std::optional(result.end->error) : std::nullopt});
    add_inputs(folder, result);
    if (result.reference_file) add_reference(*result.reference_file);
  }

  void add_inputs(const JobFolder& folder, const RunResult& result) {
    if (const auto changes = check_.changes(folder); changes) {
      refuse_changed_inputs(folder, *changes);
    } else {
      summary_.warnings.push_back(fmt::format("{}: {}", folder.id(), inputs_not_recorded));
    }
    for (const InputFile& input : result.inputs) add_input(input, result.inputs.front().name);
  }

  void add_input(const InputFile& input, const std::string& scene) {
    const bool of_scene = input.role == InputRole::buffer || input.role == InputRole::texture;
    const fs::path file = check_.find(input, scene);
    std::string name = input.name;
    if (of_scene) {
      const fs::path scene_file = check_.find({InputRole::scene, scene}, scene);
      name = (fs::path(scene).parent_path() /
              file.lexically_relative(fs::canonical(scene_file.parent_path())))
                 .lexically_normal()
                 .string();
    }
    if (is_left_out(name)) {
      if (std::find(manifest_.left_out.begin(), manifest_.left_out.end(), input) ==
          manifest_.left_out.end()) {
        manifest_.left_out.push_back(input);
      }
      return;
    }
    if (input.role != InputRole::reference || file_is_named(input.name))
      add(file, "scenes/" + name);
  }

  bool is_left_out(const std::string& name) const {
    return std::any_of(options_.leave_out.begin(), options_.leave_out.end(),
                       [&](const auto& p) { return ::fnmatch(p.c_str(), name.c_str(), 0) == 0; });
  }

  /// Whether a reference is a file below a scenes root, not a stored reference or a job.
  static bool file_is_named(const std::string& name) { return fs::path(name).has_extension(); }

  /// A reference below the data folder: its folder without what only resuming needs.
  void add_reference(const std::string& picture) {
    const fs::path folder = fs::path(picture).parent_path();
    const fs::path relative = folder.lexically_relative(fs::absolute(data_.dir));
    if (relative.empty() || *relative.begin() == "..") return;
    for (const char* name : {"image.exr", "job.json", "outcome.json", "inputs.json"}) {
      if (fs::exists(folder / name)) add(folder / name, "data/" + (relative / name).string());
    }
  }

  const SweepFolder& sweep_;
  const DataRoot& data_;
  const PackOptions& options_;
  InputCheck check_;
  std::string top_;
  TarWriter tar_;
  std::set<std::string> packed_;
  Manifest manifest_;
  PackSummary summary_;
};

}  // namespace

PackSummary pack_sweep(const SweepFolder& sweep, const DataRoot& data, const ScenesRoots& scenes,
                       const PackOptions& options, const fs::path& out) {
  return Packing(sweep, data, scenes, options, out).run();
}

}  // namespace lacuna
