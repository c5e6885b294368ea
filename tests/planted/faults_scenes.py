"""Faults in the reading of scenes."""

from fault import Fault

GLTF = ("test_scene",)

FAULTS = [
    Fault("skins keep their node's transform", "renderer/gltf/gltf_vertices.cpp",
          "return local(i) * (skin_ ? skin_->to_world(i) : source_.node.to_world);",
          "return local(i) * (skin_ ? skin_->to_world(i) * source_.node.to_world : source_.node.to_world);"),
    Fault("rotations go the long way", "renderer/gltf/gltf_keyframes.cpp",
          "if (cosine < 0) {", "if (cosine > 0) {"),
    Fault("sparse values stand half as far apart", "renderer/gltf/gltf_accessors.h",
          "return sparse_.values() + at * element_bytes_;", "return sparse_.values() + at * element_bytes_ / 2;"),
    Fault("Draco's values are not mapped to its points", "renderer/gltf/gltf_draco.cpp",
          "draco::AttributeValueIndex at = from->mapped_index(draco::PointIndex(i));",
          "draco::AttributeValueIndex at(i);", GLTF),
    Fault("any few bytes claim any mesh", "renderer/gltf/gltf_draco.cpp",
          "if (d.triangles > most_triangles_per_byte * bytes) {", "if (d.triangles > max_decoded_bytes) {", GLTF),
    Fault("instances ignore their node", "renderer/gltf/gltf_instances.cpp",
          "instance.to_world = attributes.transform(i) * node.to_world;",
          "instance.to_world = attributes.transform(i);", GLTF),
    Fault("an instance's transform is transposed for Embree's error", "renderer/geometry/instance.cpp",
          "linear[k][i] = to_scene[i][k];", "linear[i][k] = to_scene[i][k];", GLTF),
    Fault("a variant takes the first mapping", "renderer/gltf/gltf_material_choice.cpp",
          "if (std::ranges::find(listed, variant) == listed.end()) continue;", "if (listed.empty()) continue;", GLTF),
    Fault("bitangents ignore their sign", "renderer/geometry/tangent_frame.cpp",
          "std::copysign(1.0, double(t.w))}", "1.0}", ("test_scene test_path",)),
    Fault("normal maps ignore their scale", "renderer/geometry/surface.cpp",
          "(2 * texel.y - 1) * scale", "(2 * texel.y - 1)", ("test_scene test_path", "test_renderer")),
    Fault("the files' environments are not turned", "renderer/emitters/environment_cube.cpp",
          "to_cube_(scene.environment->to_world.transposed())", "to_cube_(scene.environment->to_world)", GLTF),
    Fault("coats have the normal of their base", "renderer/gltf/gltf_materials.cpp",
          "coat.own_normal = coat.factor > 0 && !same;", "coat.own_normal = false;", GLTF),
    Fault("only one of two media absorbs", "renderer/geometry/medium.h",
          "if (b != nullptr && b != a) extinction += b->extinction;", "", ("test_scene test_path", "test_renderer")),
    Fault("glossiness is roughness", "renderer/gltf/gltf_shading_models.cpp",
          "out.roughness = 1 - glossiness;", "out.roughness = glossiness;", GLTF),
    Fault("unlit surfaces keep their mirror", "renderer/gltf/gltf_shading_models.cpp",
          "  out.specular = 0;\n", "", ("test_scene", "test_renderer")),
]
