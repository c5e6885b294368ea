// Inputs that change: a result is that of its inputs or is refused, never a mixture.
#include <fmt/format.h>

#include <algorithm>

#include "jobs/spec/problems.h"
#include "jobs/store/inputs.h"
#include "renderer/images/exr_write.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

/// The job is run again after the file `name` has changed: it is refused by that name.
void expect_refusal(Stage& stage, const JobFolder& folder, const std::string& name, Check& check) {
  try {
    stage.go_on(folder);
    check.require(false, "the change was not noticed");
  } catch (const BadJob& e) {
    check.require(std::string(e.what()).find('"' + name + '"') != std::string::npos,
                  std::string("the refusal does not name the file: ") + e.what());
  }
}

/// A file of a job that has two contents.
struct ChangingFile {
  InputRole role;
  std::string name;
  std::function<void(Stage&, bool changed)> write;
};

ChangingFile scene_file() {
  return {InputRole::scene, "changing.glb", [](Stage& stage, bool changed) {
            const Bytes bytes = furnace({.albedo = changed ? 0.25 : 0.5});
            put_file(stage.file("changing.glb"),
                     {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
          }};
}

ChangingFile environment_file() {
  return {InputRole::environment, "changing.exr", [](Stage& stage, bool changed) {
            const std::vector<double> rgb(3 * 8 * 4, changed ? 2 : 1);
            write_exr(stage.file("changing.exr"),
                      {8, 4, {{"", {"R", "G", "B"}, rgb}}, PixelType::single_float, {}});
          }};
}

/// Whether the job is done, or goes on to a larger budget: run again with the changed file it is
/// refused, and with the first content under a new date it is not.
Row changed_file(const ChangingFile& file, bool extended) {
  const std::string state = extended ? "extended" : "done";
  return {fmt::format("another {}, {}", enum_name(file.role), state),
          [=](Stage& stage, const Method& method, Check& check) {
            scene_file().write(stage, false);
            file.write(stage, false);
            JobSpec job = stage.job(method, "changing.glb");
            job.budget.iterations = 2;
            if (file.role == InputRole::environment) {
              job.environment = EnvironmentSettings{file.name, 1, 0};
            }
            const JobFolder folder = stage.run(job, [] { return false; });
            if (extended) {
              job.budget.iterations = 4;
              folder.write_job(job);
              JobState queued = folder.read_state();
              queued.state = State::queued;
              folder.write_state(queued);
            }
            const InputList inputs = read_inputs(folder).value();
            const bool reads =
                std::any_of(inputs.begin(), inputs.end(), [&](const InputFile& input) {
                  return input.role == file.role && input.name == file.name;
                });
            file.write(stage, true);
            if (reads) expect_refusal(stage, folder, file.name, check);
            file.write(stage, false);
            check.require(stage.go_on(folder) == Outcome::done, "a new date is taken for a change");
            check.require(reads || file.role != InputRole::scene, "the scene is not recorded");
          }};
}

}  // namespace

std::vector<Row> input_rows(const Effort& effort) {
  if (effort.quick)
    return {changed_file(scene_file(), false), changed_file(environment_file(), true)};
  return {changed_file(scene_file(), false), changed_file(scene_file(), true),
          changed_file(environment_file(), false), changed_file(environment_file(), true)};
}

}  // namespace lacuna::extremes
