#pragma once

#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "renderer/settings/integrator_settings.h"

namespace lacuna::test {

/// One way to make a picture.
struct Method {
  std::string name;
  IntegratorSettings settings;
  friend std::ostream& operator<<(std::ostream& out, const Method& m) { return out << m.name; }
};

/// Without roulette, which costs power where paths must be long (agreement_test.cpp has it apart).
inline PathLengths whole_paths(int max_depth) {
  return {.max_depth = max_depth, .roulette_depth = max_depth};
}
/// `settings` for paths of so many edges.
template <class S>
S of_length(S settings, int max_depth) {
  static_cast<PathLengths&>(settings) = whole_paths(max_depth);
  return settings;
}
inline PathSettings path_tracing(int max_depth) { return {whole_paths(max_depth)}; }
inline LightSettings light_tracing(int max_depth, int paths = 0) {
  LightSettings s{whole_paths(max_depth)};
  s.light_paths = paths;
  return s;
}
/// With paths that go to what the eye sees.
inline LightSettings light_towards_eye(int max_depth) {
  LightSettings s = light_tracing(max_depth);
  s.light_guide = SkeletonLightGuideSettings{};
  return s;
}
inline BdptSettings joining(int max_depth, const ConnectionsSettings& connections) {
  BdptSettings s{whole_paths(max_depth)};
  s.connections = connections;
  return s;
}
/// The same, with light paths that go to what the eye sees.
inline BdptSettings joining_towards_eye(int max_depth, const ConnectionsSettings& connections) {
  BdptSettings s = joining(max_depth, connections);
  s.light_guide = SkeletonLightGuideSettings{};
  return s;
}

/// `use(S{})` for each alternative of a variant of settings, that is for each row of a registry.
template <class... Ts, class Use>
void for_each_choice(const std::variant<Ts...>&, Use&& use) {
  (use(Ts{}), ...);
}

/// `settings` with a radius that does not shrink, where they merge.
inline IntegratorSettings fixed_radius(IntegratorSettings settings, double radius,
                                       RadiusUnit unit) {
  std::visit(
      [&](auto& s) {
        if constexpr (requires { s.radius_unit; }) {
          s.radius = radius;
          s.radius_unit = unit;
          s.alpha = 1;
        }
      },
      settings);
  return settings;
}

/// A guide that does something in small pictures: where it could learn to do nothing it is told.
template <class S>
S in_small_pictures(S s) {
  if constexpr (requires { s.leaf_vertices; }) s.leaf_vertices = 100;
  if constexpr (requires { s.probability = AutoNumber{0.5}; }) s.probability = AutoNumber{0.5};
  return s;
}

/// Every guide of the registry but the BSDF's own, with what it can learn given and, where that can
/// show in small pictures, learned.
inline std::vector<std::pair<std::string, GuideSettings>> guides() {
  std::vector<std::pair<std::string, GuideSettings>> all;
  for_each_choice(GuideSettings{}, [&]<class S>(const S& s) {
    if constexpr (std::is_same_v<S, BsdfGuideSettings>) return;
    all.emplace_back(S::name, in_small_pictures(s));
    constexpr bool needs_many_paths = std::is_same_v<S, FaceIrradianceGuideSettings>;
    if constexpr (requires(S x) { x.probability = AutoNumber{}; } && !needs_many_paths) {
      S learning = s;
      learning.probability = AutoNumber{};
      if constexpr (requires { learning.strength = AutoNumber{}; })
        learning.strength = AutoNumber{};
      all.emplace_back("learning_" + std::string(S::name), learning);
    }
  });
  return all;
}
/// Path tracing with every guide, and bidirectional path tracing with each once.
inline std::vector<Method> guided(int max_depth) {
  std::vector<Method> all;
  for (const auto& [name, guide] : guides()) {
    PathSettings path = path_tracing(max_depth);
    path.guide = guide;
    all.push_back({"path_" + name, path});
    // Portals walk as faces do; of the skeleton, what learns.
    if (name == "portals" || name == "learning_portals" || name == "skeleton") continue;
    BdptSettings bdpt = joining(max_depth, PairedSettings{});
    bdpt.guide = guide;
    all.push_back({"bdpt_" + name, bdpt});
  }
  return all;
}

/// `Settings` with few light paths, and changed by `change`.
template <class Settings, class Change>
Settings resampled(int light_paths, const Change& change) {
  Settings s;
  s.light_paths = light_paths;
  if constexpr (requires { s.record_density; }) s.record_density = 0.03;  // of small pictures
  change(s);
  return s;
}
template <class Settings>
Settings resampled(int light_paths) {
  return resampled<Settings>(light_paths, [](Settings&) {});
}

/// Every choice of connections of the registry as it is by default.
inline std::vector<Method> connections(int max_depth, int light_paths = 64) {
  std::vector<Method> all;
  for_each_choice(ConnectionsSettings{}, [&]<class S>(const S& s) {
    if constexpr (requires { s.light_paths; }) {
      all.push_back({std::string(S::name), joining(max_depth, resampled<S>(light_paths))});
    } else {
      all.push_back({std::string(S::name), joining(max_depth, s)});
    }
  });
  all.push_back(
      {"paired_one_ray", joining(max_depth, PairedSettings{.rays = ConnectionRays::one})});
  return all;
}

/// Metropolis light transport with every mutation of the registry, with few chains that are longer
/// than one step in small pictures.
inline std::vector<Method> metropolis(int max_depth) {
  std::vector<Method> all;
  for_each_choice(MutationSettings{}, [&]<class S>(const S& mutation) {
    for (const int direct_samples : {1, 0}) {
      MetropolisSettings s{whole_paths(max_depth)};
      s.mutation = mutation;
      s.chains = 20;
      s.mutations = 4;
      s.bootstrap = 2;
      s.direct_samples = direct_samples;
      all.push_back({std::string(S::name) + (direct_samples > 0 ? "_direct_light_apart" : ""), s});
    }
  });
  return all;
}

/// Many-light rendering with `visibility`, in a small picture.
inline ManyLightsSettings lit_by(int max_depth, int light_paths,
                                 const VisibilitySettings& visibility) {
  ManyLightsSettings s{whole_paths(max_depth)};
  s.light_paths = light_paths;
  s.visibility = visibility;
  std::visit(
      [](auto& v) {
        if constexpr (requires { v.cache_points; }) v.cache_points = 20;
        if constexpr (requires { v.map_size; }) v.map_size = 16;
        if constexpr (requires { v.levels; }) v.levels = 6;
      },
      s.visibility);
  return s;
}

/// Many-light rendering with every visibility that has the right mean.
inline std::vector<Method> many_lights(int max_depth, int light_paths = 64) {
  std::vector<Method> all;
  const auto add = [&](const std::string& name, const VisibilitySettings& visibility,
                       auto&& change) {
    ManyLightsSettings s = lit_by(max_depth, light_paths, visibility);
    change(s);
    all.push_back({name, s});
  };
  for_each_choice(VisibilitySettings{}, [&]<class S>(const S& s) {
    if constexpr (!requires { S::biased; }) {
      add("lights_" + std::string(S::name), s, [](ManyLightsSettings&) {});
    }
  });
  add("lights_on_emitters", ExactVisibilitySettings{},
      [](auto& s) { s.direct = DirectLighting::lights; });
  add("lights_mostly_path_tracing", ExactVisibilitySettings{}, [](auto& s) {
    s.bound = 5;
    s.direct = DirectLighting::lights;
  });
  add("lights_random", ExactVisibilitySettings{},
      [](auto& s) { s.gather = RandomLightsSettings{.lights = 16}; });
  add("lights_interleaved", ExactVisibilitySettings{},
      [](auto& s) { s.gather = RandomLightsSettings{.interleave = 3}; });
  add("lights_culled_for_cubes", ExactVisibilitySettings{},
      [](auto& s) { s.gather = RandomLightsSettings{.lights = 16, .cull_for = CullFor::cubes}; });
  add("lights_of_clusters", ProbabilisticVisibilitySettings{}, [](auto& s) {
    std::get<ProbabilisticVisibilitySettings>(s.visibility).guess = CellsGuessSettings{};
    s.gather = ClusterLightsSettings{.lights = 16, .nodes = 32};
  });
  return all;
}

/// Many-light rendering with every visibility that has not.
inline std::vector<Method> approximate_lights(int max_depth, int light_paths = 64) {
  ManyLightsSettings filtered = lit_by(max_depth, light_paths, ExactVisibilitySettings{});
  filtered.gather = RandomLightsSettings{.lights = 16, .filter_radius = 2};
  ManyLightsSettings cuts = lit_by(max_depth, light_paths, ExactVisibilitySettings{});
  cuts.gather = LightcutsSettings{};
  std::vector<Method> all{{"lights_filtered", filtered}, {"lightcuts", cuts}};
  for_each_choice(VisibilitySettings{}, [&]<class S>(const S& s) {
    if constexpr (requires { S::biased; }) {
      all.push_back({"lights_" + std::string(S::name), lit_by(max_depth, light_paths, s)});
    }
  });
  return all;
}

/// Every method that merges, with what it can do at least once.
inline std::vector<Method> merging(int max_depth) {
  std::vector<Method> all;
  const auto add = [&]<class S>(const char* name, S s, auto&& change) {
    s = of_length(s, max_depth);
    s.radius = 0.02;
    s.radius_unit = RadiusUnit::scene;
    change(s);
    all.push_back({name, s});
  };
  add("vcm", VcmSettings{}, [](auto&) {});
  add("vcm_merges_only", VcmSettings{}, [](auto& s) { s.connect = false; });
  add("vcm_guided", VcmSettings{},
      [](auto& s) { s.guide = in_small_pictures(SdTreeGuideSettings{}); });
  add("vcm_guided_from_both_ends", VcmSettings{}, [](auto& s) {
    s.guide = in_small_pictures(SdTreeGuideSettings{});
    s.light_guide = SkeletonLightGuideSettings{};
  });
  add("vcm_skeleton", VcmSettings{},
      [](auto& s) { s.connections = SkeletonConnectionsSettings{}; });
  add("sppm", SppmSettings{}, [](auto& s) { s.light_paths = 300; });
  add("sppm_photons_only", SppmSettings{}, [](auto& s) {
    s.next_event_estimation = false;
    s.kernel = PhotonKernel::epanechnikov;
    s.least_roughness = 0;
  });
  add("sppm_towards_eye", SppmSettings{},
      [](auto& s) { s.light_guide = SkeletonLightGuideSettings{}; });
  add("photon_map", PhotonMapSettings{}, [](auto&) {});
  add("photon_map_caustics", PhotonMapSettings{}, [](auto& s) {
    s.caustic_paths = 500;
    s.next_event_estimation = false;
  });
  add("photon_map_gather", PhotonMapSettings{}, [](auto& s) {
    s.final_gather = true;
    s.caustic_paths = 500;
  });
  add("photon_map_gather_photons_only", PhotonMapSettings{}, [](auto& s) {
    s.final_gather = true;
    s.next_event_estimation = false;
  });
  return all;
}

/// Every flag and every named value of the choices, at least once away from its default, alone and
/// with others.
inline std::vector<Method> unusual_connections(int max_depth, int light_paths = 64) {
  using Skeleton = SkeletonConnectionsSettings;
  using Cache = ImportanceCacheSettings;
  std::vector<Method> all;
  const auto add = [&]<class S>(const char* name, S, const auto& change) {
    all.push_back({name, joining(max_depth, resampled<S>(light_paths, change))});
  };
  add("uniform, counted as one", UniformSettings{}, [](auto& s) { s.count_as = 1; });
  add("uniform, counted as all paths", UniformSettings{}, [](auto& s) { s.count_as = 0; });
  add("skeleton, counted as all paths", Skeleton{}, [](auto& s) { s.count_as = 0; });
  add("skeleton, every node", Skeleton{}, [](auto& s) { s.acceptance = 0; });
  add("skeleton, visible only", Skeleton{}, [](auto& s) { s.unshadowed = false; });
  add("skeleton, unshadowed only", Skeleton{}, [](auto& s) { s.visible = false; });
  add("skeleton, neither", Skeleton{}, [](auto& s) { s.visible = s.unshadowed = false; });
  add("skeleton, most of both sides", Skeleton{}, [](auto& s) {
    s.combination = Combination::max;
    s.sides = LightSides::both;
  });
  for (const int size : {8, 64}) {
    add(size == 8 ? "skeleton, coarse node maps" : "skeleton, node maps", Skeleton{},
        [size](auto& s) {
          s.node_visibility = NodeVisibilityTest::node_maps;
          s.map_size = size;
          s.acceptance = 0;
        });
  }
  add("cache, counted as a thousand", Cache{}, [](auto& s) { s.count_as = 1000; });
  add("cache, all four", Cache{}, [](auto& s) { s.unshadowed = s.bounded = true; });
  add("cache, most of all four", Cache{}, [](auto& s) {
    s.unshadowed = s.bounded = true;
    s.combination = Combination::max;
  });
  add("cache, none but uniform", Cache{}, [](auto& s) { s.full = false; });
  add("cache, bounded only, one neighbour", Cache{}, [](auto& s) {
    s.full = false;
    s.bounded = true;
    s.neighbours = 1;
  });
  add("cache, more neighbours than records", Cache{}, [](auto& s) {
    s.neighbours = 64;
    s.record_density = 0.005;
  });
  using Probabilistic = ProbabilisticConnectionsSettings;
  add("probabilistic, as published", Probabilistic{}, [](auto& s) {
    s.count_as = 1;
    s.draws = s.neighbours = 1;
    s.roulette = 0;
    s.splat_paths = 1;
  });
  add("probabilistic, unweighted, several draws and records", Probabilistic{}, [](auto& s) {
    s.weighted = false;
    s.draws = 3;
    s.neighbours = 4;
  });
  add("probabilistic, all uniform", Probabilistic{}, [](auto& s) { s.uniform = 1; });
  add("probabilistic, hardly any uniform, few records", Probabilistic{}, [](auto& s) {
    s.uniform = 0.05;
    s.record_density = 0.005;
  });
  return all;
}

}  // namespace lacuna::test
