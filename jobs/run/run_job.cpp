#include "jobs/run/run_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "analysis/space/memory_limit.h"
#include "base/storage/atomic_file.h"
#include "base/storage/available_memory.h"
#include "base/storage/peak_memory.h"
#include "jobs/run/choosing.h"
#include "jobs/run/input_check.h"
#include "jobs/run/machine_watch.h"
#include "jobs/run/obstacle.h"
#include "jobs/run/prepare.h"
#include "jobs/run/reference.h"
#include "jobs/run/render_loop.h"
#include "jobs/run/report.h"
#include "jobs/run/results.h"
#include "jobs/run/shard_folders.h"
#include "jobs/run/trace.h"
#include "jobs/spec/byte_size.h"
#include "renderer/images/image_module.h"
#include "renderer/integrators/integrator.h"
#include "renderer/path/unreached_emitters.h"

namespace lacuna {

namespace {

/// The job's state on disk and its phases' times while it runs.
class Running {
 public:
  Running(const JobFolder& folder, Observer& observer) : folder_(folder), observer_(observer) {
    state_ = folder.read_state();
    state_.state = State::running;
    state_.attempts += 1;
    state_.started = utc_now();
    if (state_.created.empty()) state_.created = state_.started;
    state_.finished.clear();
    state_.phase.clear();
    state_.error.clear();
    state_.warnings.clear();
  }

  void phase(const std::string& name) {
    // Synced once, so that no earlier end is found after a power failure.
    const bool begins = std::exchange(state_.phase, name).empty();
    folder_.write_state(state_, begins);
    observer_.phase(name);
  }
  const std::string& phase_name() const { return state_.phase; }
  void warn(const std::string& line) {
    state_.warnings.push_back(line);
    observer_.warning(line);
  }
  void finish(State state, const std::string& error = "") {
    state_.state = state;
    state_.phase.clear();
    state_.error = error;
    state_.finished = utc_now();
    folder_.write_state(state_);
  }
  /// After an exception, which takes precedence: a failure to write the state is only a warning.
  void stop(const std::exception& e) {
    const bool may_go_on = obstacle_of(e) != Obstacle::none;
    try {
      finish(may_go_on ? State::interrupted : State::failed, reason_of(e));
    } catch (const std::exception& second) {
      observer_.warning(second.what());
    }
  }
  const std::vector<std::string>& warnings() const { return state_.warnings; }

 private:
  JobFolder folder_;
  Observer& observer_;
  JobState state_;
};

/// Reports a reference's progress as that of the waiting job.
class ReferenceObserver final : public Observer {
 public:
  ReferenceObserver(const JobFolder& job, Observer& inner) : job_(job), inner_(inner) {}
  void phase(const std::string&) override {}
  void progress(const Progress& p) override {
    job_.write_progress(p);
    inner_.progress(p);
  }
  void milestone(const std::string& line) override { inner_.milestone("reference: " + line); }
  void warning(const std::string& line) override { inner_.warning("reference: " + line); }

 private:
  const JobFolder& job_;
  Observer& inner_;
};

/// Runs the job in `folder`, or waits while another process does.
Outcome run_or_wait(const JobFolder& folder, const RunContext& context) {
  constexpr auto pause = std::chrono::milliseconds(200);
  while (!context.interrupted()) {
    try {
      return run_job(folder, context);
    } catch (const FolderBusy&) {
      std::this_thread::sleep_for(pause);
    }
  }
  return Outcome::interrupted;
}

/// Renders the reference as a separate job, by the first process that needs it. None if
/// interrupted.
std::optional<Reference> make_auto_reference(const JobFolder& folder, const JobSpec& spec,
                                             const Prepared& prepared, const RunContext& context) {
  // A job without a camera shares the reference of one that names the first.
  JobSpec named = spec;
  if (!named.camera.object) named.camera.name = prepared.camera_name;
  const ReferenceJob job = auto_reference(named, context.data, prepared.content);
  const auto& dir = job.folder.dir();
  const auto read = [&] {
    return read_reference("auto", job.folder.file("image.exr"), spec.resolution);
  };
  if (!std::filesystem::exists(dir)) {
    std::filesystem::create_directories(dir.parent_path());
    try {
      JobFolder::create(dir, job.spec);
    } catch (const std::invalid_argument&) {
      // Another process created it: the lock decides which renders.
    }
  }
  // Its inputs are unchanged: their hashes are in its name.
  if (job.folder.read_state().state == State::done) return read();
  ReferenceObserver observer(folder, context.observer);
  const RunContext own{context.data, context.scenes, context.threads,     context.interrupted,
                       observer,     nullptr,        context.seconds_left};
  if (run_or_wait(job.folder, own) == Outcome::interrupted) return std::nullopt;
  return read();
}

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
    if (spec.reference == "auto") {
      reference = make_auto_reference(folder, spec, prepared, context);
      if (!reference) return Outcome::interrupted;
    } else {
      reference = find_reference(spec, context.data, context.scenes);
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
