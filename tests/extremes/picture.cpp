#include "tests/extremes/picture.h"

#include <algorithm>

#include "jobs/run/prepare.h"

namespace lacuna::extremes {
namespace {

const std::function<bool()> never_interrupted = [] { return false; };

}  // namespace

RunContext Stage::context(const std::function<bool()>& interrupted) {
  return {DataRoot{folder_ / "data"}, ScenesRoots({folder_.path()}), 2, interrupted, observer_};
}

const std::string& Stage::scene(const std::string& name, const std::function<Bytes()>& make) {
  const auto [at, is_new] = scenes_.try_emplace(name, name + ".glb");
  if (is_new) folder_.write(at->second, make());
  return at->second;
}

JobSpec Stage::job(const Method& method, const std::string& scene) const {
  JobSpec job;
  job.scene = scene;
  job.resolution = {effort_.side(), effort_.side()};
  job.integrator = job_integrator(method.settings);
  job.budget.iterations = effort_.iterations();
  job.analysis.resolution = effort_.resolution();
  return job;
}

std::uint64_t Stage::texels_read(const JobSpec& job) {
  const Prepared p = prepare(job, context(never_interrupted));
  return p.scene->has_emitters() ? p.scene->emitters().texels_read() : 0;
}

Counters Stage::iterate(const JobSpec& job, const std::function<void(const Image&)>& see) {
  const RunContext surroundings = context(never_interrupted);
  const Prepared p = prepare(job, surroundings);
  analyse(p, *p.integrator);
  Counters counters;
  for (std::int64_t i = 0; i < *job.budget.iterations; ++i) {
    Image image(job.resolution[0], job.resolution[1]);
    counters += p.integrator->iterate(
        {*p.scene, *p.camera, *p.pool, job.seed, static_cast<std::uint64_t>(i), never_interrupted},
        image);
    see(image);
  }
  return counters;
}

Picture Stage::render(const JobSpec& job) {
  Picture picture;
  picture.film = Film(job.resolution[0], job.resolution[1]);
  picture.counters = iterate(job, [&](const Image& image) {
    picture.film.add(picture.film.iterations(), image);
    picture.blocks.push_back(block_means(image));
  });
  return picture;
}

const Picture& Stage::plain(const Method& method) {
  const auto found = plain_.find(method.name);
  if (found != plain_.end()) return found->second;
  const std::string& name = scene("room", [] { return room({}); });
  return plain_[method.name] = render(job(method, name));
}

JobFolder Stage::run(const JobSpec& job, const std::function<bool()>& interrupted) {
  std::filesystem::remove_all(folder_ / "job");
  JobFolder folder = JobFolder::create(folder_ / "job", job);
  run_job(folder, context(interrupted));
  return folder;
}

Outcome Stage::go_on(const JobFolder& folder) {
  return run_job(folder, context(never_interrupted));
}

}  // namespace lacuna::extremes
