#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "jobs/cli/commands.h"
#include "jobs/spec/problems.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

namespace {

namespace fs = std::filesystem;

/// A job and its name in the list.
struct Listed {
  std::string name;
  JobFolder folder;
};

bool is_job(const fs::path& folder) { return fs::is_regular_file(folder / "job.json"); }

/// The jobs directly in `folder` whose names end in `ending`, sorted.
std::vector<Listed> jobs_in(const fs::path& folder, const std::string& ending) {
  std::vector<Listed> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path path = entry.path().lexically_normal();
    if (!path.filename().string().ends_with(ending) || !is_job(path)) continue;
    found.push_back({path.string(), JobFolder(path)});
  }
  std::sort(found.begin(), found.end(),
            [](const Listed& a, const Listed& b) { return a.name < b.name; });
  return found;
}

/// The job in `folder`, the jobs below it, or the runs of a sweep.
std::vector<Listed> jobs_of(const fs::path& folder) {
  if (is_job(folder)) return {{folder.string(), JobFolder(folder)}};
  const bool sweep =
      fs::is_regular_file(folder / "sweep.json") && fs::is_directory(folder / "runs");
  auto found = jobs_in(sweep ? folder / "runs" : folder, "");
  if (found.empty()) {
    throw BadJob(
        {{"", fmt::format("{} is not a job's folder and contains none", folder.string())}});
  }
  return found;
}

/// The jobs of the data folder, and the results of `lacuna render` in the working directory.
std::vector<Listed> usual_jobs() {
  std::vector<Listed> found;
  for (const JobFolder& folder : list_jobs(DataRoot::from_environment().jobs())) {
    found.push_back({folder.id(), folder});
  }
  for (Listed& job : jobs_in(".", ".job")) found.push_back(std::move(job));
  return found;
}

void print_jobs(const std::vector<fs::path>& folders) {
  std::vector<Listed> jobs;
  if (folders.empty()) jobs = usual_jobs();
  for (const fs::path& folder : folders) {
    for (Listed& job : jobs_of(folder)) jobs.push_back(std::move(job));
  }
  fmt::print("{:<24} {:<12} {:>6} {:>10}  {}\n", "JOB", "STATE", "%", "ERROR", "SCENE  LABEL");
  for (const auto& [name, folder] : jobs) {
    const JobSpec spec = folder.read_job();
    const auto progress = folder.read_progress();
    fmt::print("{:<24} {:<12} {:>6} {:>10}  {}  {}\n", name, enum_name(folder.read_state().state),
               progress ? fmt::format("{:.0f}", 100 * progress->share) : "",
               progress && progress->error ? fmt::format("{:.3g}", *progress->error) : "",
               spec.scene, spec.label);
  }
}

void print_scenes() {
  for (const std::string& name : ScenesRoots::from_environment().list()) fmt::print("{}\n", name);
}

}  // namespace

void add_list(CLI::App& app, int& code) {
  struct ListOptions {
    std::vector<fs::path> folders;
    bool scenes = false;
  };
  const auto o = std::make_shared<ListOptions>();
  CLI::App* command = app.add_subcommand(
      "list",
      "List the jobs of the data folder, oldest first, and NAME.job folders of the working "
      "directory");
  command
      ->add_option("FOLDER", o->folders,
                   "list these jobs' folders instead, or the jobs in these folders or sweeps")
      ->check(CLI::ExistingDirectory);
  command->add_flag("--scenes", o->scenes, "list the scenes that jobs can name instead")
      ->excludes("FOLDER");
  command->callback([o, &code] {
    if (o->scenes) {
      print_scenes();
    } else {
      print_jobs(o->folders);
    }
    code = exit_done;
  });
}

}  // namespace lacuna
