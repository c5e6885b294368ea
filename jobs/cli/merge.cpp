#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "jobs/cli/commands.h"
#include "jobs/cli/render_job.h"
#include "jobs/run/shard_folders.h"
#include "jobs/spec/problems.h"
#include "jobs/store/new_folder.h"

namespace lacuna {

namespace {

namespace fs = std::filesystem;

/// Creates the merged job's folder, or reuses an unfinished one of the same command.
JobFolder merged_folder(const fs::path& named, const Shard& first) {
  JobSpec spec = first.spec;
  spec.shard = 0;
  const fs::path out = folder_path(named);
  if (!fs::exists(out)) return JobFolder::create(out, spec);
  JobFolder folder(out);
  const bool unfinished = fs::exists(folder.file("job.json")) && folder.read_job() == spec &&
                          folder.read_state().state != State::done;
  if (!unfinished) {
    throw BadJob({{"", fmt::format("{} exists; allowed: a new folder", out.string())}});
  }
  return folder;
}

}  // namespace

void add_merge(CLI::App& app, int& code) {
  struct Options {
    fs::path out;
    std::vector<fs::path> shards;
    RenderOptions render;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "merge", "Merge all shards of a job (`lacuna render --shard K/N`) into one job's folder");
  command->footer(
      "The order of the shards does not matter. The picture has the same bits as on one machine, "
      "unless the\nmethod learns: then each shard learned from its own iterations, as report.json "
      "states. Times\nare sums; the column longest_seconds of curve.csv is the longest clock. "
      "`lacuna extend OUT` continues.");
  command->add_option("OUT", o->out, "the new folder")->required();
  command->add_option("SHARD", o->shards, "the shards' folders, all of them")
      ->required()
      ->check(CLI::ExistingDirectory);
  command
      ->add_option("-t,--threads", o->render.threads,
                   "number of threads instead of the job's; 0: one per core")
      ->check(CLI::Range(0, 1024));
  command->add_flag("-q,--quiet", o->render.quiet, "show warnings and errors only");
  command->callback([o, &code] {
    const std::vector<Shard> shards = read_shards(o->shards);
    const JobFolder folder = merged_folder(o->out, shards.front());
    o->render.shards = &shards;
    code = render_folder(folder, o->render);
  });
}

}  // namespace lacuna
