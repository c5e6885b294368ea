#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/geometry/disjoint_sets.h"
#include "base/json/json_text.h"
#include "base/storage/available_memory.h"
#include "base/storage/peak_memory.h"
#include "jobs/cli/commands.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/overlay.h"
#include "jobs/cli/scene_choice_options.h"
#include "jobs/cli/settings_options.h"
#include "jobs/cli/terminal.h"
#include "jobs/run/clock.h"
#include "jobs/spec/byte_size.h"
#include "jobs/store/job_folder.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene_shape.h"

namespace lacuna {

namespace {

struct AnalyzeOptions {
  std::string scene, camera;
  SceneChoice choice;
  AnalysisSettings analysis;
  std::filesystem::path out;
  int threads = 0;
  bool no_cache = false;
  bool json = false;
};

/// An existing path, or a name below the scenes roots.
std::filesystem::path find_scene(const std::string& name) {
  if (std::filesystem::is_regular_file(name)) return name;
  return ScenesRoots::from_environment().resolve(name, {".glb", ".gltf"});
}

/// Independent loops and connected parts of a graph.
struct GraphCounts {
  std::size_t components = 0, loops = 0;

  explicit GraphCounts(const SkeletonGraph& g) : components(g.nodes()) {
    DisjointSets parts(g.nodes());
    for (std::uint32_t node = 0; node < g.nodes(); ++node) {
      for (const std::uint32_t other : g.of(node)) {
        if (other < node) parts.join(node, other) ? --components : ++loops;
      }
    }
  }
};

/// Number of gates of radius 0, next to a node that touches the scene.
std::size_t gates_of_radius_0(const VisibilityGates& gates) {
  return static_cast<std::size_t>(
      std::count_if(gates.gates.begin(), gates.gates.end(),
                    [](const VisibilityGate& gate) { return gate.radius == 0; }));
}

/// Counts that describe a scene's empty space.
OrderedJson shape(const AnalyzeOptions& o, SpaceAnalysis& space) {
  const Voxels& v = space.voxels();
  const Imath::V3i n = v.scene.size();
  const Domain& d = space.domain();
  const GraphCounts counts(space.skeleton());
  return {{"scene", o.scene},
          {"grid", {n.x, n.y, n.z}},
          {"voxel_size", v.transform.voxel_size},
          {"scene_voxels", v.scene.count()},
          {"domain_voxels", d.voxels_kept},
          {"dropped_voxels", d.voxels_dropped},
          {"domain_components", d.components_kept},
          {"dropped_components", d.components_dropped},
          {"buried_seeds", d.seeds_buried},
          {"complex_faces", space.complex_faces()},
          {"nodes", space.skeleton().nodes()},
          {"filtered_nodes", space.filtered().graph.nodes()},
          {"simplified_nodes", space.simplified().graph.nodes()},
          {"components", counts.components},
          {"loops", counts.loops},
          {"clusters", space.clusters().count},
          {"gates", space.gates().gates.size()},
          {"gates_of_radius_0", gates_of_radius_0(space.gates())},
          {"regions", space.regions().regions.size()},
          {"portals", space.portals().portals.size()}};
}

OrderedJson steps(const ArtefactStore& store) {
  OrderedJson all = OrderedJson::array();
  for (const ArtefactRecord& r : store.records()) {
    const bool built = r.origin == ArtefactRecord::Origin::built;
    all.push_back({{"name", r.type},
                   {"origin", built ? "built" : "loaded"},
                   {"seconds", r.seconds},
                   {"disk_bytes", r.disk_bytes},
                   {"peak_memory_bytes", r.peak_memory_bytes}});
  }
  return all;
}

void print(const OrderedJson& j) {
  for (const auto& [name, value] : j.items()) {
    if (name == "steps" || name == "peak_memory_bytes" || name == "threads") continue;
    std::string label = name;
    std::replace(label.begin(), label.end(), '_', ' ');
    fmt::print("{:<20} {}\n", label,
               value.is_string() ? value.get<std::string>() : json_text(value));
  }
  fmt::print("\n{:<20} {:>8} {:>10} {:>12} {:>12}\n", "STEP", "", "SECONDS", "ON DISK",
             "PEAK MEMORY");
  double total = 0;
  for (const OrderedJson& step : j["steps"]) {
    const auto seconds = step["seconds"].get<double>();
    const auto bytes = step["disk_bytes"].get<std::uint64_t>();
    total += seconds;
    fmt::print("{:<20} {:>8} {:>10.3f} {:>12} {:>12}\n", step["name"].get<std::string>(),
               step["origin"].get<std::string>(), seconds, bytes > 0 ? byte_size_text(bytes) : "-",
               byte_size_text(step["peak_memory_bytes"].get<std::uint64_t>()));
  }
  fmt::print("{:<20} {:>8} {:>10.3f}\n", "all", "", total);
  fmt::print("peak memory {}, {} threads\n",
             byte_size_text(j["peak_memory_bytes"].get<std::uint64_t>()), json_text(j["threads"]));
}

void write_overlays(const std::filesystem::path& dir, const SceneData& scene,
                    SpaceAnalysis& space) {
  std::filesystem::create_directories(dir);
  const GridTransform& grid = space.voxels().transform;
  const auto write = [&](const char* name, const std::vector<OverlayMesh>& overlay) {
    write_overlay(dir / name, scene, overlay);
    fmt::print(stderr, "{}\n", (dir / name).string());
  };
  write("skeleton.glb", skeleton_overlay(space.skeleton(), grid));
  write("filtered.glb", skeleton_overlay(space.filtered().graph, grid));
  write("clusters.glb", cluster_overlay(space.simplified(), space.clusters(), grid));
  write("gates.glb", gate_overlay(space.gates(), grid));
  write("portals.glb", portal_overlay(space.portals(), space.regions(), grid));
}

void analyze(const AnalyzeOptions& o) {
  const ThreadPool pool(o.threads, interrupt_requested());
  Terminal terminal({}, false);
  const SceneData scene = load_gltf(find_scene(o.scene), nullptr, o.choice);
  const CameraData camera = choose_camera(scene, o.camera, o.scene);
  const DataRoot data = DataRoot::from_environment();
  ArtefactStore store(
      {.folder = o.no_cache ? std::filesystem::path() : data.cache(),
       .byte_limit = data.cache_limit,
       .label = o.scene,
       .message = [&](const std::string& line) { terminal.milestone(line); },
       .warning = [&](const std::string& line) { terminal.warning(line); },
       .building = [&](const std::string& type) { terminal.status("building " + type); },
       .interrupted = interrupt_requested()});
  SpaceAnalysis space({.triangles = [&] { return triangle_soup(scene); },
                       .geometry = geometry_key(scene),
                       .seeds = [&] { return domain_seeds(scene, camera, false); },
                       .settings = o.analysis,
                       .byte_limit = memory_to_take},
                      store, pool);
  space.node_map();
  space.filtered_map();
  OrderedJson result = shape(o, space);
  terminal.status({});
  result["steps"] = steps(store);
  result["peak_memory_bytes"] = peak_memory();
  result["threads"] = pool.threads();
  o.json ? fmt::print("{}", document_text(result)) : print(result);
  if (!o.out.empty()) write_overlays(o.out, scene, space);
}

}  // namespace

void add_analyze(CLI::App& app, int& code) {
  const auto o = std::make_shared<AnalyzeOptions>();
  CLI::App* command = app.add_subcommand("analyze",
                                         "Analyse the shape of a scene's empty space (voxels, "
                                         "skeleton, regions) and print the time and "
                                         "memory of each step");
  command
      ->add_option("SCENE", o->scene,
                   "a scene (.glb, .gltf): a file, or a name below a scenes root")
      ->required();
  command->add_option("--camera", o->camera,
                      "camera that selects the part of the empty space (default: the first)");
  add_scene_choice(*command, o->choice);
  SettingsOptions options(*command);
  describe(options, o->analysis);
  command->add_option(
      "--out", o->out,
      "write skeleton, filtered, clusters, gates and portals (.glb), each with the scene, to DIR");
  command->add_option("--threads", o->threads, "number of threads; 0: one per core (default)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--no-cache", o->no_cache, "rebuild everything and store nothing in the cache");
  command->add_flag("--json", o->json, "print JSON, for scripts");
  command->callback([o, &code] {
    try {
      analyze(*o);
      code = exit_done;
    } catch (const Stopped&) {
      code = exit_interrupted;
    }
  });
}

}  // namespace lacuna
