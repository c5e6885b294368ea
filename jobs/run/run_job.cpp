#include "jobs/run/run_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <set>

#include "analysis/space/memory_limit.h"
#include "base/storage/atomic_file.h"
#include "base/storage/available_memory.h"
#include "base/storage/peak_memory.h"
#include "jobs/run/choosing.h"
#include "jobs/run/foreign_job.h"
#include "jobs/run/input_check.h"
#include "jobs/run/job_reference.h"
#include "jobs/run/machine_watch.h"
#include "jobs/run/render_loop.h"
#include "jobs/run/report.h"
#include "jobs/run/results.h"
#include "jobs/run/running.h"
#include "jobs/run/shard_folders.h"
#include "jobs/run/trace.h"
#include "jobs/spec/byte_size.h"
#include "renderer/images/image_module.h"
#include "renderer/integrators/integrator.h"
#include "renderer/path/unreached_emitters.h"

namespace lacuna {

namespace {

/// Bits are guaranteed on one machine only: libraries may select code by the processor.
void warn_of_processors(const std::vector<Shard>& shards, Running& running) {
  std::set<std::string> names;
  for (const Shard& shard : shards) names.insert(shard.processor);
  if (names.size() < 2) return;
  running.warn(
      fmt::format("the shards were rendered on {} processor models ({}): their last bits may "
                  "differ from those of one machine",
                  names.size(), fmt::join(names, "; ")));
}

/// The inputs of the checkpoint or shards from which this run continues; none if it starts from the
/// beginning, or if they are not recorded.
std::optional<InputList> earlier_inputs(const JobFolder& folder, const std::vector<Shard>* shards,
                                        Running& running) {
  const bool resumes = std::filesystem::exists(folder.file("checkpoint.bin")) ||
                       std::filesystem::exists(folder.file("choice.json"));
  if (shards == nullptr && !resumes) return std::nullopt;
  auto inputs = read_inputs(shards != nullptr ? shards->front().folder : folder);
  if (!inputs) running.warn(inputs_not_recorded);
  return inputs;
}

/// The choice so far, for a job of `auto`. An unreadable file is renamed.
std::optional<Choice> choice_of(const JobSpec& spec, const JobFolder& folder, Running& running) {
  if (!std::holds_alternative<AutoSettings>(spec.integrator)) return std::nullopt;
  try {
    if (auto choice = read_choice(folder)) return choice;
  } catch (const std::system_error&) {
    throw;
  } catch (const std::runtime_error& e) {
    std::filesystem::rename(folder.file("choice.json"), folder.file("choice.unusable"));
    running.warn(fmt::format("{}; kept as choice.unusable, choosing again", e.what()));
  }
  return new_choice(spec);
}

Outcome render(const JobFolder& folder, const RunContext& context, Running& running) {
  const double started = clock_seconds(CLOCK_MONOTONIC);
  // TBB loads its own libraries at first use, and would wait for those of the image module.
  ThreadPool(1).for_each(1, [](int) {});
  const ImageModuleLoading images;  // every job writes images
  PhaseSeconds phases;
  running.phase("loading");
  JobSpec spec = folder.read_job();
  if (std::holds_alternative<ForeignSettings>(spec.integrator)) {
    return run_foreign(folder, spec, context, running);
  }
  std::optional<Choice> choice = choice_of(spec, folder, running);
  if (const auto chosen = chosen_job(spec, choice)) spec = *chosen;
  std::optional<std::vector<Shard>> shards;
  if (context.shards != nullptr) {
    shards = *context.shards;
  } else {
    shards = shards_to_merge(folder);
  }
  Prepared prepared;
  {
    const ScopedSeconds timed(phases["load"]);
    prepared = prepare(spec, context);
  }
  for (const std::string& w : prepared.warnings) running.warn(w);
  const auto earlier = earlier_inputs(folder, shards ? &*shards : nullptr, running);
  InputList& inputs = prepared.inputs;
  if (earlier) refuse_changed_inputs(folder, changed_inputs(*earlier, inputs));

  std::optional<Choosing> choosing;
  try {
    const ScopedSeconds timed(phases["analysis"]);
    if (prepared.integrator == nullptr) {
      running.phase("analysing");
      choosing.emplace(folder, spec, *choice, prepared, context);
    } else {
      if (prepared.integrator->needs().space) running.phase("analysing");
      analyse(prepared, *prepared.integrator);
      prepared.space->close();
    }
  } catch (const WaitInterrupted&) {
    return Outcome::interrupted;
  }

  std::optional<Reference> reference;
  if (!spec.reference.empty()) {
    running.phase("reference");
    const ScopedSeconds timed(phases["reference"]);
    const WorkSection section(*prepared.pool, reference_section);
    reference = job_reference(folder, spec, prepared, context);
    if (!reference) return Outcome::interrupted;
    if (spec.reference != "auto") {
      inputs.push_back(reference->input);
      if (earlier) refuse_changed_inputs(folder, changed_inputs(*earlier, inputs));
    }
  }
  write_inputs(folder, inputs);

  {
    // Loading must not compete with timed work.
    const ScopedSeconds timed(phases["images"]);
    images.wait();
  }
  const double preparation = phases["load"] + phases["analysis"];
  const std::optional<double> limit =
      spec.budget.seconds ? spec.budget.seconds : spec.budget.cpu_seconds;
  if (limit && preparation > *limit) {
    running.warn(fmt::format(
        "preparation took {:.1f} s, more than the budget of {:g} s, which limits only rendering",
        preparation, *limit));
  }

  const MachineWatch watch;
  if (choosing) {
    running.phase("choosing");
    if (!choosing->run()) return Outcome::interrupted;
    prepared.integrator = choosing->take_integrator();
    choice = choosing->choice();
    spec = *chosen_job(spec, choice);
    choosing.reset();
  }

  running.phase("rendering");
  const RenderTask task{folder,
                        spec,
                        *prepared.scene,
                        *prepared.camera,
                        *prepared.pool,
                        *prepared.integrator,
                        reference ? &*reference : nullptr,
                        context.interrupted,
                        context.observer,
                        phases,
                        prepared.content,
                        context.seconds_left};
  RenderLoop loop(task);
  if (shards) {
    loop.merge(*shards);
    warn_of_processors(*shards, running);
  } else if (choice && !std::filesystem::exists(folder.file("checkpoint.bin"))) {
    loop.begin_from(chosen_folder(folder, *choice), spent_elsewhere(*choice));
  } else {
    loop.resume();
  }
  if (loop.run() == RenderLoop::End::interrupted) {
    if (const std::uint64_t unsaved = loop.unsaved_iterations(); unsaved > 0) {
      running.warn(fmt::format(
          "stopped before a checkpoint could be written; {} of {} iterations are rendered again "
          "(LACUNA_GRACE=SECONDS, or --grace of the service, gives a stop more time)",
          unsaved, loop.spent().iterations));
    }
    return Outcome::interrupted;
  }
  const auto disturbance = watch.disturbance();

  running.phase("writing");
  {
    const ScopedSeconds timed(phases["write"]);
    const WorkSection section(*prepared.pool, "write");
    write_results(task, loop);
  }
  if (loop.counters().rejected > 0) {
    running.warn(
        fmt::format("{} non-finite contributions were discarded", loop.counters().rejected));
  }
  if (const auto paths = light_paths_of_iteration(spec)) {
    const double all = *paths * static_cast<double>(loop.film().iterations());
    for (const std::string& w : unreached_emitters(*prepared.scene, *prepared.camera, all)) {
      running.warn(w);
    }
  }
  if (const auto tail = error_tail(loop.film()); tail && !tail->mean_is_known()) {
    running.warn(fmt::format(
        "est_rmse is unreliable: the squared errors are heavy-tailed (Pareto index {:.2f}, "
        "reliable up to {:.2f}), so rare bright paths dominate and the picture may be too dark",
        tail->index, tail->limit));
  }
  if (!context.trace.empty()) write_trace(prepared.pool->log(), context.trace);
  write_file_atomically(
      folder.file("report.json"),
      write_report({task, loop, prepared.camera_name, running.warnings(),
                    prepared.artefacts->records(), disturbance, started, choice}));
  if (choice) std::filesystem::remove(chosen_folder(folder, *choice).file("checkpoint.bin"));
  return Outcome::done;
}

/// Whether the job is done. Throws BadJob if its inputs have changed since.
bool is_done(const JobFolder& folder, const RunContext& context) {
  if (folder.read_state().state != State::done) return false;
  const auto changes = InputCheck(context.data, context.scenes).changes(folder);
  if (changes) {
    refuse_changed_inputs(folder, *changes);
  } else {
    context.observer.warning(inputs_not_recorded);
  }
  return true;
}

}  // namespace

Outcome run_job(const JobFolder& folder, const RunContext& context) {
  if (is_done(folder, context)) return Outcome::done;
  const auto lock = folder.try_lock();
  if (!lock) {
    throw FolderBusy(
        fmt::format("{}: another process is rendering this job", folder.dir().string()));
  }
  if (is_done(folder, context)) return Outcome::done;
  Running running(folder, context.observer);
  try {
    const Outcome outcome = render(folder, context, running);
    running.finish(outcome == Outcome::done ? State::done : State::interrupted);
    return outcome;
  } catch (const Stopped&) {
    running.finish(State::interrupted);
    return Outcome::interrupted;
  } catch (const std::bad_alloc&) {
    const MemoryLimitError named(fmt::format("{}: an allocation failed; {} in use, {} available",
                                             running.phase_name(), byte_size_text(peak_memory()),
                                             byte_size_text(available_memory())));
    running.stop(named);
    throw named;
  } catch (const std::exception& e) {
    running.stop(e);
    throw;
  }
}

}  // namespace lacuna
