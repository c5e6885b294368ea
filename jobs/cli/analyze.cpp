#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>

#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/clock.h"
#include "jobs/run/overlay.h"
#include "jobs/spec/byte_size.h"
#include "jobs/store/job_folder.h"
#include "jobs/store/machine.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene_shape.h"

namespace lacuna {

namespace {

struct Options {
  std::string scene, camera;
  AnalysisSettings analysis;
  std::filesystem::path out;
  int threads = 0;
  bool no_cache = false;
};

/// A path as it is, or a name below the scenes roots.
std::filesystem::path find_scene(const std::string& name) {
  if (std::filesystem::is_regular_file(name)) return name;
  return ScenesRoots::from_environment().resolve(name, {".glb", ".gltf"});
}

/// Independent loops and connected parts of a graph.
struct GraphCounts {
  std::size_t components = 0, loops = 0;

  explicit GraphCounts(const SkeletonGraph& g) {
    std::vector<bool> seen(g.nodes());
    std::vector<std::uint32_t> stack;
    for (std::uint32_t i = 0; i < g.nodes(); ++i) {
      if (seen[i]) continue;
      ++components;
      seen[i] = true;
      for (stack.push_back(i); !stack.empty();) {
        const std::uint32_t node = stack.back();
        stack.pop_back();
        for (const std::uint32_t other : g.of(node)) {
          if (!seen[other]) stack.push_back(other);
          seen[other] = true;
        }
      }
    }
    loops = g.edges() + components - g.nodes();
  }
};

void print_steps(const ArtefactStore& store) {
  fmt::print("\n{:<20} {:>8} {:>10} {:>12}\n", "STEP", "", "SECONDS", "ON DISK");
  double total = 0;
  for (const ArtefactRecord& r : store.records()) {
    const bool built = r.origin == ArtefactRecord::Origin::built;
    total += r.seconds;
    fmt::print("{:<20} {:>8} {:>10.3f} {:>12}\n", r.type, built ? "built" : "loaded", r.seconds,
               r.disk_bytes > 0 ? byte_size_text(r.disk_bytes) : "-");
  }
  fmt::print("{:<20} {:>8} {:>10.3f}\n", "all", "", total);
}

void print_shape(const Options& o, SpaceAnalysis& space) {
  const Voxels& v = space.voxels();
  const Imath::V3i n = v.scene.size();
  const Domain& d = space.domain();
  const std::size_t all =
      static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z);
  const GraphCounts counts(space.skeleton());
  const auto row = [](const char* name, const std::string& value) {
    fmt::print("{:<28} {}\n", name, value);
  };
  row("scene", o.scene);
  row("grid", fmt::format("{} x {} x {}", n.x, n.y, n.z));
  row("voxel, scene units", fmt::format("{:.6g}", v.transform.voxel_size));
  row("voxels", fmt::format("{}: {} scene, {} in the domain, {} dropped", all, v.scene.count(),
                            d.voxels_kept, d.voxels_dropped));
  row("components of empty space",
      fmt::format("{} kept, {} dropped", d.components_kept, d.components_dropped));
  row("faces of its complex", fmt::format("{}", space.complex_faces()));
  row("nodes of the skeleton",
      fmt::format("{}; {} filtered, {} simplified", space.skeleton().nodes(),
                  space.filtered().graph.nodes(), space.simplified().graph.nodes()));
  row("components, loops", fmt::format("{}, {}", counts.components, counts.loops));
  row("clusters, gates", fmt::format("{}, {}", space.clusters().count, space.gates().gates.size()));
  row("regions, portals",
      fmt::format("{}, {}", space.regions().regions.size(), space.portals().portals.size()));
}

void write_overlays(const std::filesystem::path& dir, const SceneData& scene,
                    SpaceAnalysis& space) {
  std::filesystem::create_directories(dir);
  const GridTransform& grid = space.voxels().transform;
  const auto write = [&](const char* name, const std::vector<OverlayMesh>& overlay) {
    write_overlay(dir / name, scene, overlay);
    fmt::print("{}\n", (dir / name).string());
  };
  write("skeleton.glb", skeleton_overlay(space.skeleton(), grid));
  write("filtered.glb", skeleton_overlay(space.filtered().graph, grid));
  write("clusters.glb", cluster_overlay(space.simplified(), space.clusters(), grid));
  write("gates.glb", gate_overlay(space.gates(), grid));
  write("portals.glb", portal_overlay(space.portals(), space.regions(), grid));
}

void analyze(const Options& o) {
  const ThreadPool pool(o.threads);
  Terminal terminal({}, false);
  const SceneData scene = load_gltf(find_scene(o.scene));
  const CameraData camera = choose_camera(scene, o.camera, o.scene);
  const DataRoot data = DataRoot::from_environment();
  ArtefactStore store({.folder = o.no_cache ? std::filesystem::path() : data.cache(),
                       .byte_limit = data.cache_limit,
                       .label = o.scene,
                       .message = [&](const std::string& line) { terminal.milestone(line); },
                       .warning = [&](const std::string& line) { terminal.warning(line); },
                       .interrupted = interrupt_requested()});
  SpaceAnalysis space({.triangles = [&] { return triangle_soup(scene); },
                       .geometry = geometry_key(scene),
                       .seeds = [&] { return domain_seeds(scene, camera, false); },
                       .settings = o.analysis,
                       .byte_limit = available_memory()},
                      store, pool);
  space.node_map();
  space.filtered_map();
  print_shape(o, space);
  print_steps(store);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("peak memory {}, {} threads\n",
             byte_size_text(static_cast<std::uint64_t>(usage.ru_maxrss) * 1024), pool.threads());
  if (!o.out.empty()) write_overlays(o.out, scene, space);
}

}  // namespace

void add_analyze(CLI::App& app, int& code) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "analyze",
      "The shape of a scene's empty space: voxels, skeleton, regions; what each step took");
  command
      ->add_option("SCENE", o->scene,
                   "a scene (.glb, .gltf): a file, or a name below the scenes roots")
      ->required();
  command->add_option("--camera", o->camera,
                      "whose part of the empty space counts (default: the first)");
  command
      ->add_option("--resolution", o->analysis.resolution,
                   "voxels along the longest side (default: 128)")
      ->check(CLI::Range(1, max_resolution));
  const std::map<std::string, NodeMapping> mappings{{"geodesic", NodeMapping::geodesic},
                                                    {"visible", NodeMapping::visible}};
  command->add_option("--mapping", o->analysis.mapping, "geodesic (default) or visible")
      ->transform(CLI::CheckedTransformer(mappings));
  command->add_option(
      "--out", o->out,
      "writes skeleton, filtered, clusters, gates and portals (.glb) with the scene into DIR");
  command->add_option("--threads", o->threads, "0: one for each core (default)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--no-cache", o->no_cache, "builds everything anew and keeps nothing");
  command->callback([o, &code] {
    analyze(*o);
    code = exit_done;
  });
}

}  // namespace lacuna
