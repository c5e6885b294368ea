#include "jobs/figure/figure_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "jobs/spec/described_json.h"
#include "jobs/spec/identity.h"
#include "jobs/store/new_folder.h"
#include "jobs/sweep/pointer.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

/// A folder by its path, relative to that of the figure's file, or by its id among those in
/// `known`. Throws std::runtime_error: there is no such folder.
fs::path named_folder(const std::string& name, const std::optional<fs::path>& folder,
                      const fs::path& known) {
  const bool is_path = folder && fs::exists(*folder / name);
  fs::path found = folder_path(is_path ? *folder / name : known / name);
  if (is_path || (is_job_id(name) && fs::exists(found))) return found;
  throw std::runtime_error("there is no such folder");
}

/// Gathers the jobs of a figure's methods.
class GivenJobs {
 public:
  explicit GivenJobs(const FigureSpec& spec) : spec_(spec) {}

  FigureCells run(const std::optional<fs::path>& folder) {
    const fs::path known = DataRoot::from_environment().jobs();
    for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
      const auto& names = spec_.methods[m].jobs;
      for (std::size_t j = 0; j < names.size(); ++j) {
        try {
          const JobFolder job(named_folder(names[j], folder, known));
          add(m, job.read_job(), job.dir().string());
        } catch (const std::exception& error) {
          throw BadJob({{fmt::format("/methods/{}/jobs/{}", m, j),
                         fmt::format("found \"{}\": {}; allowed: {}the id of a job", names[j],
                                     error.what(), folder ? "the folder of a job, or " : "")}});
        }
      }
    }
    set_settings();
    return {SweepFolder::of_jobs(std::move(plan_)), std::move(methods_)};
  }

 private:
  void add(std::size_t method, JobSpec job, std::string folder) {
    constexpr auto of_a_run = std::to_array<std::string_view>({"label", "seed"});
    OrderedJson document = ObjectWriter::value_of(job);
    const auto known =
        known_.try_emplace({method, hash_without(document, of_a_run)}, plan_.cells.size());
    const std::size_t cell = known.first->second;
    if (known.second) {
      plan_.cells.push_back({{}, std::move(job), {}});
      methods_.push_back(method);
      documents_.emplace_back(std::move(document));
    }
    const auto runs = std::ranges::count(plan_.runs, cell, &SweepRun::cell);
    plan_.runs.push_back({cell, static_cast<int>(runs), std::move(folder)});
  }

  void set_settings() {
    for (const auto& first : documents_.front().items()) {
      const auto differs = [&](const Json& job) { return job.at(first.key()) != first.value(); };
      if (std::ranges::find(not_in_a_reference, first.key()) == not_in_a_reference.end() &&
          std::ranges::any_of(documents_, differs)) {
        set("/" + first.key());
      }
    }
    for (std::size_t s = 0; s < spec_.scenes.size(); ++s) {
      for (const auto& [pointer, value] : spec_.scenes[s].settings) {
        const auto why = pointer_problem(pointer);
        if (why) throw BadJob({{fmt::format("/scenes/{}/settings", s), pointer + " " + *why}});
        set(pointer);
      }
    }
  }

  void set(const std::string& pointer) {
    const Json::json_pointer at(pointer);
    for (std::size_t c = 0; c < documents_.size(); ++c) {
      const Json& job = documents_[c];
      plan_.cells[c].settings[pointer].text = any_value(job.contains(at) ? job.at(at) : Json());
    }
  }

  const FigureSpec& spec_;
  SweepPlan plan_;
  std::vector<std::size_t> methods_;                                  // by cell
  std::vector<Json> documents_;                                       // by cell
  std::map<std::pair<std::size_t, std::string>, std::size_t> known_;  // cells
};

}  // namespace

FigureCells open_cells(const FigureSpec& spec, const std::optional<fs::path>& folder) {
  if (!spec.sweep) return GivenJobs(spec).run(folder);
  try {
    return {SweepFolder(named_folder(*spec.sweep, folder, DataRoot::from_environment().sweeps())),
            {}};
  } catch (const std::runtime_error& error) {
    throw BadJob(
        {{"/sweep", fmt::format("found \"{}\": {}; allowed: {}the id of a sweep", *spec.sweep,
                                error.what(), folder ? "the folder of a sweep, or " : "")}});
  }
}

}  // namespace lacuna
