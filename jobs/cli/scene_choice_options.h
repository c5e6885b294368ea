#pragma once

#include <CLI/CLI.hpp>

#include "renderer/gltf/gltf_load.h"

namespace lacuna {

/// Adds options for the keys of a job that choose among what a scene's file offers.
inline void add_scene_choice(CLI::App& command, SceneChoice& choice) {
  CLI::Option* const time = command.add_option(
      "--time", choice.seconds,
      "pose the scene at this second of its animations (default: its static pose)");
  command
      .add_option("--animation", choice.animation,
                  "the only animation to pose it by (default: all)")
      ->needs(time);
  command.add_option("--variant", choice.variant,
                     "name of the variant of its materials (default: none)");
}

}  // namespace lacuna
