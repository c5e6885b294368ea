"""Faults in the reading of other renderers' scenes."""

from fault import Fault

PBRT = "jobs/import/pbrt/"
IMPORT = ("test_import",)

FAULTS = [
    Fault("pbrt's world is never mirrored", PBRT + "pbrt_camera.cpp",
          "view.mirrored = (z.cross(y).dot(x) < 0) != panorama;", "view.mirrored = false;", IMPORT),
    Fault("pbrt's field of view is that of the height", PBRT + "pbrt_camera.cpp",
          "std::atan(std::tan(fov * std::numbers::pi / 360) * half_height)", "(fov * std::numbers::pi / 360)", IMPORT),
    Fault("pbrt's transforms apply the first last", PBRT + "pbrt_transforms.cpp",
          "at_[i] = t * at_[i];", "at_[i] = at_[i] * t;", IMPORT),
    Fault("normals do not decide what is in front", "jobs/import/mesh_normals.cpp",
          "if ((b - a).cross(c - a).dot(sum) < 0) std::swap(t[1], t[2]);", "", IMPORT),
    Fault("pbrt-v3 turns stated normals", PBRT + "pbrt_shapes.cpp", "    out.flipped = false;\n", "", IMPORT),
    Fault("pbrt's instances lose their object's transform", PBRT + "pbrt_world.cpp",
          "s.shape.to_world * state_.ctm.start();\n    add(", "state_.ctm.start();\n    add(", IMPORT),
    Fault("names of pbrt-v3 outlive their scope", PBRT + "pbrt_world.cpp",
          "if (!context_.is_v3() || pushed_.empty()) return;", "return;", IMPORT),
    Fault("pbrt's mixes are swapped", PBRT + "pbrt_materials.cpp", "v3 ? weight : rest}", "v3 ? rest : weight}", IMPORT),
    Fault("black bodies of pbrt-v4 keep their luminance", PBRT + "pbrt_colours.cpp",
          "if (!context.is_v3()) return over_luminance(c, p);", "", IMPORT),
    Fault("pbrt's powers are those of one side", PBRT + "pbrt_lights.cpp", "(out.two_sided ? 2 : 1)", "1", IMPORT),
    Fault("spots keep their inner cone", "jobs/import/spot_cone.h", "1.5 * (1 - flux) - cos_outer / 2", "1 - flux", IMPORT),
    Fault("pbrt's pictures of the environment are mirrored", PBRT + "pbrt_lights.cpp",
          "mirror.setScale(V3d(-1, 1, 1));", "", IMPORT),
    Fault("checkerboards of pbrt have small squares", PBRT + "pbrt_textures.cpp", "texture->scale *= 0.5;", "", IMPORT),
    Fault("subdivision misses its limit", PBRT + "pbrt_surfaces.cpp",
          "3 / (8 * loop_weight(", "3 / (4 * loop_weight(", IMPORT),
    Fault("files of pbrt may lie behind links", PBRT + "pbrt_context.cpp",
          'if (below.empty() || *below.begin() == "..") {', "if (below.empty()) {", IMPORT),
    Fault("equal areas forget the lower hemisphere", "jobs/import/equal_area.cpp",
          "if (direction.z < 0) {", "if (false) {", IMPORT),
    Fault("compressed files have no bound", "jobs/import/input_bytes.cpp",
          "if (out.size() > max_bytes) {", "if (false) {", IMPORT),
]
