// The grid of the analysis, from one voxel to the largest.
#include <fmt/format.h>

#include "renderer/integrators/integrator.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

std::string needs_space(const Method& method) {
  return make_integrator(method.settings)->needs().space ? "" : "does not look at the empty space";
}

/// One that does not fit into memory is refused; one voxel does.
Row grid(int resolution) {
  return {fmt::format("a grid of {}", resolution),
          [=](Stage& stage, const Method& method, Check& check) {
            const std::string& name = stage.scene("room", [] { return room({}); });
            JobSpec job = stage.job(method, name);
            job.analysis.resolution = resolution;
            const auto render = [&] { check.sound(stage.render(job)); };
            if (resolution == 1) return render();
            check.or_refused(render);
          },
          needs_space};
}

}  // namespace

std::vector<Row> space_rows(const Effort& effort) {
  if (effort.quick) return {grid(1), grid(128)};
  return {grid(1), grid(1024), grid(max_resolution)};
}

}  // namespace lacuna::extremes
