#include "tests/extremes/scenes.h"

#include <algorithm>

#include "tests/renderer/images/test_images.h"

namespace lacuna::extremes {
namespace {

using test::GlbBuilder;
using test::Triangles;

Json shining(Json material, const std::array<double, 3>& colour, double strength) {
  material["emissiveFactor"] = colour;
  material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  return material;
}

/// A builder that puts everything where scale and offset want it.
class Builder : public GlbBuilder {
 public:
  Builder(double scale, double offset) : scale_(scale), offset_(offset) {}

  void place(std::size_t mesh) {
    add_node({{"mesh", mesh},
              {"scale", {scale_, scale_, scale_}},
              {"translation", {offset_, offset_, offset_}}});
  }
  /// The six sides of a box, seen from outside or from inside.
  void add_box(const V3f& low, const V3f& high, bool from_outside, std::size_t material) {
    for (int k = 0; k < 3; ++k) {
      V3f a(0), b(0);
      a[(k + 1) % 3] = (high - low)[(k + 1) % 3];
      b[(k + 2) % 3] = (high - low)[(k + 2) % 3];
      for (const bool upper : {false, true}) {
        V3f o = low;
        if (upper) o[k] = high[k];
        const bool along = upper == from_outside;  // a x b points up the axis
        place(add_quad(o, along ? a : b, along ? b : a, static_cast<int>(material)));
      }
    }
  }
  void add_eye(const V3f& at, double yfov) {
    const V3d x = V3d(at) * scale_ + V3d(offset_);
    const std::size_t node = add_camera("eye", V3f(0), yfov);
    json["nodes"][node]["translation"] = {x.x, x.y, x.z};
  }
  /// `count` equal lights in one place that share `power` (W/sr).
  void add_points(int count, const V3f& at, double power) {
    if (count == 0) return;
    const V3d x = V3d(at) * scale_ + V3d(offset_);
    const Json place{{"translation", {x.x, x.y, x.z}}};
    Json node = json["nodes"][add_light(
        {{"type", "point"}, {"intensity", power * scale_ * scale_ / count}}, place)];
    for (int i = 1; i < count; ++i) add_node(node);
  }

 private:
  double scale_, offset_;
};

// Sixty-fourths: exact however a power of two scales them.
const V3f corner(4.171875F, 2.90625F, 5.359375F);

/// A square of cells facing down. Those of its first half have texture coordinates in the lower
/// half of a texture, the others in the upper one, and the material `other`.
void add_panel(Builder& b, int cells, std::size_t material, std::size_t other) {
  const V3f o(1.265625F, 2.859375F, 2.953125F), x(1.5F, 0, 0), z(0, 0, 1.25F);
  const auto along = [&](int i) { return static_cast<float>(i) / static_cast<float>(cells); };
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i * (cells + 1) + k); };
  std::vector<V3f> positions;
  for (int i = 0; i <= cells; ++i) {
    for (int k = 0; k <= cells; ++k) positions.push_back(o + x * along(i) + z * along(k));
  }
  const int half = (cells + 1) / 2;
  for (const auto& [first, end] : {std::pair(0, half), std::pair(half, cells)}) {
    if (first == end) continue;
    std::vector<V2f> uvs;
    for (int i = 0; i <= cells; ++i) {
      for (int k = 0; k <= cells; ++k) {
        const float u =
            std::clamp((along(i) - along(first)) / (along(end) - along(first)), 0.F, 1.F);
        uvs.emplace_back(along(k), (first == 0 ? 0.625F : 0.125F) + 0.25F * u);
      }
    }
    Triangles triangles;
    for (int i = first; i < end; ++i) {
      for (int k = 0; k < cells; ++k) {
        triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
        triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
      }
    }
    const std::size_t own = first == 0 ? material : other;
    b.place(b.add_mesh(positions, triangles, static_cast<int>(own), {}, uvs));
  }
}

/// A texture whose lower half is white, the upper one black.
std::size_t add_texture(Builder& b, int side) {
  const auto half = static_cast<std::size_t>(side) * static_cast<std::size_t>(side) / 2;
  std::vector<std::uint8_t> texels(half, 0);
  texels.resize(2 * half, 255);
  return b.add_texture(test::encode8(side, side, 1, texels));
}

/// All of it lies in the floor, so that neither the picture nor a voxel changes.
void add_clutter(Builder& b, Clutter clutter, std::size_t floor) {
  const V3f x(corner.x, 0, 0), z(0, 0, corner.z);
  const auto material = static_cast<int>(floor);
  switch (clutter) {
    case Clutter::none:
      return;
    case Clutter::zero_area:  // a point, a line, and two corners in one place
      b.place(b.add_mesh({V3f(0), x / 4, x / 2, z}, {{0, 0, 0}, {0, 1, 2}, {0, 3, 3}, {0, 1, 3}},
                         material));
      return;
    case Clutter::duplicated_vertices:  // nothing is shared, and some are there twice
      b.place(
          b.add_mesh({V3f(0), z, z + x, V3f(0), z + x, x, x, x}, {{0, 1, 2}, {3, 4, 5}}, material));
      return;
    case Clutter::coincident:
      for (int i = 0; i < 3; ++i) b.place(b.add_quad(V3f(0), z, x, material));
      return;
    case Clutter::needles:  // of the floor's length, and a millionth of it wide
      for (int i = 1; i < 100; ++i) {
        const V3f o = x * (static_cast<float>(i) / 100);
        b.place(b.add_mesh({o, o + z, o + x * 1e-6F}, {{0, 1, 2}}, material));
      }
      return;
  }
}

}  // namespace

Json diffuse(const std::array<double, 3>& albedo) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {albedo[0], albedo[1], albedo[2], 1}}, {"metallicFactor", 0}}},
          {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

Json metal(double roughness) {
  return {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", roughness}}}};
}

Json glass(double roughness) {
  return {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}},
          {"extensions",
           {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
            {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}};
}

Bytes room(const Room& r) {
  Builder b(r.scale, r.offset);
  const std::size_t white = b.add_material(diffuse({0.72, 0.7, 0.66}));
  const std::size_t red = b.add_material(diffuse({0.6, 0.2, 0.15}));
  const std::size_t shiny = b.add_material(metal(0.5));
  Json glow = shining(diffuse({0, 0, 0}), {1, 0.9, 0.7}, 3 * r.radiance);
  if (r.texels > 0) glow["emissiveTexture"] = {{"index", add_texture(b, r.texels)}};
  const std::size_t lamp = b.add_material(glow);
  const std::size_t other = r.glow == Glow::half ? b.add_material(diffuse({0, 0, 0})) : lamp;
  b.add_box(V3f(0), corner, false, white);
  b.add_box({0, 0, 2.390625F}, {2.265625F, corner.y, 2.609375F}, true, red);
  b.add_box({0.515625F, 0.015625F, 3.140625F}, {1.390625F, 0.984375F, 3.890625F}, true, shiny);
  for (int i = 0; i < r.panels; ++i) add_panel(b, r.panel_cells, lamp, other);
  add_clutter(b, r.clutter, white);
  b.add_points(r.points, {2.890625F, 1.640625F, 3.484375F}, 2 * r.radiance);
  b.add_eye({2.796875F, 1.359375F, 5.140625F}, 1.375);  // the panel is seen
  return b.glb();
}

Bytes block_on_floor(double half_side) {
  Builder b(1, 0);
  const std::size_t white = b.add_material(diffuse({0.7, 0.7, 0.7}));
  const std::size_t lamp = b.add_material(shining(diffuse({0, 0, 0}), {1, 1, 1}, 4));
  const auto side = static_cast<float>(2 * half_side);
  b.place(b.add_quad({-side / 2, 0, side / 2}, {side, 0, 0}, {0, 0, -side}, int(white)));
  b.add_box({-0.05F, 0, -0.05F}, {0.05F, 0.1F, 0.05F}, true, white);
  b.place(b.add_quad({0.25F, 0.5F, -0.1F}, {0.2F, 0, 0}, {0, 0, 0.2F}, int(lamp)));
  b.add_eye({0, 0.125F, 0.4375F}, 0.75);
  return b.glb();
}

Bytes beam(const Beam& beam) {
  Builder b(1, 0);
  const std::size_t dark = b.add_material(diffuse({0, 0, 0}));
  const std::size_t wall = b.add_material(diffuse({beam.albedo, beam.albedo, beam.albedo}));
  // Its middle is the origin, where floats are finest.
  b.add_box({-1, -1, -0.015625F}, {1, 1, 2}, false, dark);
  b.place(
      b.add_quad({-0.9375F, -0.9375F, 0}, {1.875F, 0, 0}, {0, 1.875F, 0}, static_cast<int>(wall)));
  b.add_light({{"type", "spot"},
               {"intensity", beam.intensity},
               {"spot", {{"innerConeAngle", beam.inner}, {"outerConeAngle", beam.outer}}}},
              {{"translation", {0, 0, beam.distance}}});
  // Of the cone's width, the film's diagonal takes half.
  b.add_eye({0, 0, static_cast<float>(beam.distance) - 0.125F}, 0.7 * beam.outer);
  return b.glb();
}

Bytes furnace(const Furnace& f) {
  Builder b(1, f.offset);
  const std::array<double, 3> albedo{f.albedo, f.albedo, f.albedo};
  const std::size_t wall = b.add_material(shining(diffuse(albedo), {1, 1, 1}, f.radiance));
  const V3f high(1, static_cast<float>(f.height), 1);
  b.add_box(V3f(0), high, false, wall);
  if (!f.content.is_null()) {
    b.add_box(high * 0.3125F, high * 0.65625F, true, b.add_material(f.content));
  }
  b.add_eye({0.4375F, f.eye * high.y, 0.90625F}, 1);
  return b.glb();
}

}  // namespace lacuna::extremes
