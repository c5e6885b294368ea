"""Faults in the reading of scenes."""

from fault import Fault

FAULTS = [
    Fault("skins keep their node's transform", "renderer/gltf/gltf_vertices.cpp",
          "return local(i) * (skin_ ? skin_->to_world(i) : source_.node.to_world);",
          "return local(i) * (skin_ ? skin_->to_world(i) * source_.node.to_world : source_.node.to_world);"),
    Fault("rotations go the long way", "renderer/gltf/gltf_keyframes.cpp",
          "if (cosine < 0) {", "if (cosine > 0) {"),
    Fault("sparse values stand half as far apart", "renderer/gltf/gltf_accessors.h",
          "return sparse_.values() + at * element_bytes_;", "return sparse_.values() + at * element_bytes_ / 2;"),
]
