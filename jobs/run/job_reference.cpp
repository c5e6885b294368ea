#include "jobs/run/job_reference.h"

#include <chrono>
#include <thread>

namespace lacuna {
namespace {

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

}  // namespace

std::optional<Reference> job_reference(const JobFolder& folder, const JobSpec& spec,
                                       const Prepared& prepared, const RunContext& context) {
  if (spec.reference == "auto") return make_auto_reference(folder, spec, prepared, context);
  return find_reference(spec, context.data, context.scenes);
}

}  // namespace lacuna
