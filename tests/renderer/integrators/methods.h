#pragma once

#include <ostream>
#include <string>
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
inline PathSettings path_tracing(int max_depth) { return {whole_paths(max_depth)}; }
inline LightSettings light_tracing(int max_depth, int paths = 0) {
  LightSettings s{whole_paths(max_depth)};
  s.light_paths = paths;
  return s;
}
inline BdptSettings joining(int max_depth, const ConnectionsSettings& connections) {
  BdptSettings s{whole_paths(max_depth)};
  s.connections = connections;
  return s;
}

/// That learns from small pictures.
inline SdTreeGuideSettings small_sd_tree() {
  SdTreeGuideSettings tree;
  tree.leaf_vertices = 100;
  return tree;
}
/// Every guide, with what it can learn given and learned.
inline std::vector<std::pair<std::string, GuideSettings>> guides() {
  SkeletonGuideSettings learning;
  learning.strength = learning.probability = {};
  FaceIrradianceGuideSettings faces;  // which would learn to do nothing in small pictures
  faces.probability = {0.5};
  PortalsGuideSettings portals;
  portals.probability = {0.5};
  return {{"skeleton", SkeletonGuideSettings{}},
          {"learning_skeleton", learning},
          {"portals", portals},
          {"learning_portals", PortalsGuideSettings{}},
          {"face_irradiance", faces},
          {"sd_tree", small_sd_tree()}};
}
/// Path tracing with every guide, and bidirectional path tracing with some.
inline std::vector<Method> guided(int max_depth) {
  std::vector<Method> all;
  for (const auto& [name, guide] : guides()) {
    PathSettings path = path_tracing(max_depth);
    path.guide = guide;
    all.push_back({"path_" + name, path});
    if (name != "learning_skeleton" && name != "face_irradiance") continue;
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

/// Every choice of connections as it is by default.
inline std::vector<Method> connections(int max_depth, int light_paths = 64) {
  const int n = light_paths;
  return {
      {"paired", joining(max_depth, PairedSettings{})},
      {"uniform", joining(max_depth, resampled<UniformSettings>(n))},
      {"skeleton", joining(max_depth, resampled<SkeletonSettings>(n))},
      {"importance_cache", joining(max_depth, resampled<ImportanceCacheSettings>(n))},
      {"hybrid", joining(max_depth, resampled<HybridSettings>(n))},
  };
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
  const auto add = [&](const char* name, const VisibilitySettings& visibility, auto&& change) {
    ManyLightsSettings s = lit_by(max_depth, light_paths, visibility);
    change(s);
    all.push_back({name, s});
  };
  const auto as_it_is = [](ManyLightsSettings&) {};
  add("lights_exact", ExactVisibilitySettings{}, as_it_is);
  add("lights_on_emitters", ExactVisibilitySettings{},
      [](auto& s) { s.direct = DirectLighting::lights; });
  add("lights_mostly_path_tracing", ExactVisibilitySettings{}, [](auto& s) {
    s.bound = 5;
    s.direct = DirectLighting::lights;
  });
  add("lights_random", ExactVisibilitySettings{},
      [](auto& s) { s.gather = RandomLightsSettings{.lights = 16}; });
  add("lights_probabilistic", ProbabilisticVisibilitySettings{}, as_it_is);
  add("lights_roulette", RouletteVisibilitySettings{}, as_it_is);
  return all;
}

/// Many-light rendering with every visibility that has not.
inline std::vector<Method> approximate_lights(int max_depth, int light_paths = 64) {
  ManyLightsSettings filtered = lit_by(max_depth, light_paths, ExactVisibilitySettings{});
  filtered.gather = RandomLightsSettings{.lights = 16, .filter_radius = 2};
  return {{"lights_none", lit_by(max_depth, light_paths, NoVisibilitySettings{})},
          {"lights_filtered", filtered},
          {"lights_interpolated", lit_by(max_depth, light_paths, InterpolatedVisibilitySettings{})},
          {"lights_gates", lit_by(max_depth, light_paths, GatesVisibilitySettings{})},
          {"lights_node_maps", lit_by(max_depth, light_paths, NodeMapsVisibilitySettings{})},
          {"lights_view_maps", lit_by(max_depth, light_paths, ViewMapsVisibilitySettings{})}};
}

/// Every flag and every named value of the choices, at least once away from its default, alone and
/// with others.
inline std::vector<Method> unusual_connections(int max_depth, int light_paths = 64) {
  using Skeleton = SkeletonSettings;
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
  return all;
}

}  // namespace lacuna::test
