#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/terminal.h"
#include "jobs/import/mitsuba/read_mitsuba.h"
#include "jobs/import/pbrt/read_pbrt.h"
#include "jobs/import/scene_write.h"
#include "jobs/run/check.h"
#include "jobs/spec/job_json.h"
#include "renderer/core/scene_error.h"

namespace lacuna {
namespace {

ImportedScene read_foreign_scene(const std::filesystem::path& file, MissingFiles missing) {
  const std::string kind = file.extension().string();
  if (kind == ".xml") return read_mitsuba(file, missing);
  if (kind == ".pbrt" || file.string().ends_with(".pbrt.gz")) return read_pbrt(file, missing);
  throw SceneError(
      fmt::format("\"{}\" ends in \"{}\"; allowed: .xml (Mitsuba), .pbrt, .pbrt.gz (pbrt)",
                  file.string(), kind));
}

void print_notes(const std::vector<ImportNote>& notes) {
  std::size_t place = 0, name = 0, treatment = 0;
  for (const ImportNote& n : notes) {
    place = std::max(place, n.place.size());
    name = std::max(name, std::min<std::size_t>(48, n.name.size()));
    treatment = std::max(treatment, n.treatment.size());
  }
  for (const ImportNote& n : notes) {
    fmt::print("{:<{}}  {:<{}}  {:<{}}  {}\n", n.place, place, n.name, name, n.treatment, treatment,
               n.how);
  }
}

void import_scene(const std::filesystem::path& file, std::filesystem::path out,
                  MissingFiles missing) {
  const ImportedScene scene = read_foreign_scene(file, missing);
  if (out.empty()) out = file.stem();
  out = std::filesystem::absolute(out / "").parent_path();
  const std::vector<ImportNote> notes = write_imported_scene(scene, out);
  print_notes(notes);
  Terminal terminal({}, true);
  const RunContext context{DataRoot::from_environment(), ScenesRoots({out.parent_path()}), -1,
                           interrupt_requested(), terminal};
  const JobSpec job = parse_job(read_file(out / "job.json", max_job_bytes));
  for (const std::string& w : check_job(job, context)) terminal.warning(w);
  fmt::print("{}: {} shapes, {} lights, {} cameras; {} notes\n", (out / "job.json").string(),
             scene.shapes.size(), scene.lights.size(), scene.cameras.size(), notes.size());
}

}  // namespace

void add_import(CLI::App& app, int& code) {
  const auto file = std::make_shared<std::filesystem::path>();
  const auto out = std::make_shared<std::filesystem::path>();
  const auto missing = std::make_shared<std::string>("refuse");
  CLI::App* command = app.add_subcommand(
      "import",
      "Write a scene of another renderer as glTF with a job: DIR/scene.glb, its textures, "
      "DIR/job.json; print what is not represented exactly");
  command
      ->add_option(
          "FILE", *file,
          "a scene of Mitsuba 0.6, 2 or 3 (.xml), or of pbrt-v3 or pbrt-v4 (.pbrt, .pbrt.gz)")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--out", *out,
                      "the folder to write, below a scenes root; default: FILE's name without its "
                      "ending, in the working directory");
  command
      ->add_option("--missing", *missing,
                   "what to do about meshes and textures that do not exist: refuse, or skip (leave "
                   "them out, each with a line)")
      ->check(CLI::IsMember({"refuse", "skip"}))
      ->capture_default_str();
  command->callback([file, out, missing, &code] {
    import_scene(*file, *out, *missing == "skip" ? MissingFiles::skip : MissingFiles::refuse);
    code = exit_done;
  });
}

}  // namespace lacuna
