#include "renderer/gltf/gltf_animation.h"

#include <set>
#include <utility>

#include "renderer/gltf/gltf_keyframes.h"

namespace lacuna::gltf {
namespace {

struct Channel {
  GltfObject place, target;
  std::size_t node;
  std::string path;
};

template <std::size_t N>
std::array<double, N> array_of(const std::vector<double>& values) {
  std::array<double, N> out;
  std::copy_n(values.begin(), N, out.begin());
  return out;
}

void animate(const Channel& channel, const std::vector<GltfObject>& samplers,
             const file::Model& model, double seconds, NodePose& pose) {
  const auto index = channel.place.index("sampler", samplers.size(), "samplers");
  if (!index) channel.place.fail("sampler is missing");
  const auto value = [&](AnimatedKind kind) {
    return Keyframes(samplers[*index], model, kind).at(seconds);
  };
  if (channel.path == "translation") {
    pose.translation = array_of<3>(value(AnimatedKind::vector));
  } else if (channel.path == "scale") {
    pose.scale = array_of<3>(value(AnimatedKind::vector));
  } else if (channel.path == "rotation") {
    pose.rotation = array_of<4>(value(AnimatedKind::rotation));
  } else {
    pose.weights = value(AnimatedKind::weights);
  }
}

/// The channels that move a node; others are warned of.
std::vector<Channel> channels_of(const GltfObject& animation, const std::vector<GltfObject>& nodes,
                                 Warnings& warnings) {
  std::vector<Channel> out;
  for (const GltfObject& channel : animation.objects("channels")) {
    const auto target = channel.object("target");
    if (!target) channel.fail("target is missing");
    const std::string path = target->string("path");
    if (path == "pointer") {
      warnings.first_of("pointer",
                        target->label() + ": KHR_animation_pointer is not supported and left out");
      continue;
    }
    if (path != "translation" && path != "rotation" && path != "scale" && path != "weights") {
      target->refuse("path", "\"translation\", \"rotation\", \"scale\" or \"weights\"");
    }
    const auto node = target->index("node", nodes.size(), "nodes");
    if (!node) continue;  // glTF 2.0, section 3.11: to be ignored
    if (nodes[*node].has("matrix") && path != "weights") {
      nodes[*node].fail("has a matrix, and " + target->label() + " animates its " + path +
                        "; allowed: translation, rotation and scale in place of the matrix");
    }
    out.push_back({channel, *target, *node, path});
  }
  return out;
}

std::vector<GltfObject> animations_named(const GltfObject& root, const std::string& name) {
  std::vector<GltfObject> out;
  std::string allowed;
  for (const GltfObject& animation : root.objects("animations")) {
    const std::string own = animation.string("name", "");
    if (name.empty() || own == name) out.push_back(animation);
    if (!own.empty()) allowed += (allowed.empty() ? "" : ", ") + in_quotes(own);
  }
  if (out.empty() && !name.empty()) {
    root.fail("no animation is called " + in_quotes(name) + "; allowed: " +
              (allowed.empty() ? "none, as the file has none with a name" : allowed));
  }
  return out;
}

}  // namespace

Pose pose_at(const GltfObject& root, const file::Model& model, double seconds,
             const std::string& name, Warnings& warnings) {
  const auto nodes = root.objects("nodes");
  const auto animations = animations_named(root, name);
  if (animations.empty()) warnings.once("the file has no animations: time changes nothing");
  Pose pose;
  std::set<std::pair<std::size_t, std::string>> animated;
  for (const GltfObject& animation : animations) {
    const auto samplers = animation.objects("samplers");
    for (const Channel& channel : channels_of(animation, nodes, warnings)) {
      if (!animated.emplace(channel.node, channel.path).second) {
        channel.target.warn("animated twice",
                            "the " + channel.path + " of " + nodes[channel.node].label() +
                                " is animated already; the first animation counts");
        continue;
      }
      animate(channel, samplers, model, seconds, pose[channel.node]);
    }
  }
  return pose;
}

}  // namespace lacuna::gltf
