#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "jobs/archive/check_archive.h"
#include "jobs/archive/pack_sweep.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/results_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

struct ArchiveOptions {
  fs::path what, out, against;
  PackOptions pack;
  bool check = false, without_pictures = false;
};

int pack_folder(const ArchiveOptions& o) {
  const SweepFolder sweep(o.what);
  fs::path out = o.out;
  if (out.empty()) {
    out = sweep.dir();
    out.replace_extension(".tar.zst");
  }
  if (!out.string().ends_with(".tar.zst")) {
    throw BadJob(
        {{"", fmt::format("--out {}: allowed: a name that ends in .tar.zst", out.string())}});
  }
  const PackSummary s =
      pack_sweep(sweep, DataRoot::from_environment(), ScenesRoots::from_environment(), o.pack, out);
  for (const std::string& w : s.warnings) fmt::print(stderr, "warning: {}\n", w);
  fmt::print("{}: {} runs, {} files, {} inputs left out, {:.1f} MB\n", out.string(), s.runs,
             s.files, s.left_out, 1e-6 * double(fs::file_size(out)));
  return exit_done;
}

int check_packed(const ArchiveOptions& o) {
  InputCheck inputs(DataRoot::from_environment(), ScenesRoots::from_environment());
  std::optional<SweepFolder> against;
  if (!o.against.empty()) against.emplace(o.against);
  const ArchiveCheck c = check_archive(o.what, inputs, against);
  for (const std::string& line : c.notes) fmt::print("note: {}\n", line);
  for (const std::string& line : c.differences) fmt::print("differs: {}\n", line);
  fmt::print("{} files and {} runs, {} differences\n", c.files, c.runs, c.differences.size());
  return c.differences.empty() ? exit_done : exit_error;
}

}  // namespace

void add_archive(CLI::App& app, int& code) {
  const auto o = std::make_shared<ArchiveOptions>();
  CLI::App* command = app.add_subcommand(
      "archive", "Pack a sweep with all that is needed to repeat it, or check such an archive");
  command
      ->add_option("WHAT", o->what,
                   "a sweep's folder; with --check an archive or its manifest.json")
      ->required()
      ->check(existing_path);
  CLI::Option* out = command->add_option("-o,--out", o->out,
                                         "the archive (default: NAME.tar.zst beside the sweep)");
  CLI::Option* leave_out = command->add_option(
      "--leave-out", o->pack.leave_out,
      "input files of which only the hash is kept, by a pattern of their names such as 'sponza/*'");
  CLI::Option* without =
      command->add_flag("--without-pictures", o->without_pictures, "leave out the runs' image.exr");
  CLI::Option* checks = command->add_flag("--check", o->check,
                                          "say what differs: files, version, machine, inputs that "
                                          "were left out; exit code 1 if any does");
  checks->excludes(out)->excludes(leave_out)->excludes(without);
  command->add_option("--against", o->against, "with --check: compare the errors with this sweep's")
      ->needs(checks)
      ->check(CLI::ExistingDirectory);
  command->callback([o, &code] {
    o->pack.pictures = !o->without_pictures;
    code = o->check ? check_packed(*o) : pack_folder(*o);
  });
}

}  // namespace lacuna
