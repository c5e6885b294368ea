// The grid of the analysis, from one voxel to the largest; visibility clusters at the ends of
// alpha.
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

/// Clusters as small or as large as alpha makes them, and gates that are never shut.
Row clusters(double alpha) {
  return {fmt::format("clusters of alpha {}", alpha),
          [=](Stage& stage, const Method& method, Check& check) {
            const std::string& name = stage.scene("room", [] { return room({}); });
            JobSpec job = stage.job(method, name);
            job.analysis.cluster_alpha = alpha;
            job.analysis.node_radius = NodeRadius::voxel;
            check.sound(stage.render(job));
          },
          needs_space};
}

}  // namespace

std::vector<Row> space_rows(const Effort& effort) {
  if (effort.quick) return {grid(1), grid(128), clusters(0), clusters(1)};
  return {grid(1), grid(1024), grid(max_resolution), clusters(0), clusters(1)};
}

}  // namespace lacuna::extremes
