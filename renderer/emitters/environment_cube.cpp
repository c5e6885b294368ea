#include "renderer/emitters/environment_cube.h"

#include <fmt/format.h>

#include <numbers>

namespace lacuna {
namespace {

/// The radiance of a decoded cube map.
class CubeRadiance {
 public:
  CubeRadiance(const SceneData& scene) : to_cube_(scene.environment->to_world.transposed()) {
    side_ = scene.environment->side;
    for (std::size_t f = 0; f < 6; ++f) {
      const auto index = static_cast<std::size_t>(scene.environment->faces[f]);
      faces_[f] = scene.textures[index].get();
      if (const V2i size = faces_[f]->size(); size != V2i(side_, side_)) {
        throw SceneError(
            fmt::format("{}: has {} x {} texels; allowed: {} x {}, by specularImageSize",
                        faces_[f]->label(), size.x, size.y, side_, side_));
      }
    }
  }

  /// Bilinear within a face.
  Rgb towards(const V3d& in_world) const {
    V3d w;
    to_cube_.multDirMatrix(in_world, w);
    const double ax = std::abs(w.x), ay = std::abs(w.y), az = std::abs(w.z);
    // Columns, to the right as seen from inside, and rows, downwards; the +y face has +z below.
    if (ax >= ay && ax >= az) return on_face(w.x > 0 ? 0 : 1, w.x > 0 ? w.z : -w.z, -w.y, ax);
    if (ay >= az) return on_face(w.y > 0 ? 2 : 3, -w.x, w.y > 0 ? w.z : -w.z, ay);
    return on_face(w.z > 0 ? 4 : 5, w.z > 0 ? -w.x : w.x, -w.y, az);
  }

 private:
  Rgb on_face(std::size_t face, double right, double down, double ahead) const {
    const auto at = [&](double across) { return (across / ahead + 1) / 2 * side_ - 0.5; };
    const double x = at(right), y = at(down);
    const double left = std::floor(x), top = std::floor(y);
    const int i = static_cast<int>(left), j = static_cast<int>(top);
    const auto fx = static_cast<float>(x - left), fy = static_cast<float>(y - top);
    return (1 - fy) * ((1 - fx) * texel(face, i, j) + fx * texel(face, i + 1, j)) +
           fy * ((1 - fx) * texel(face, i, j + 1) + fx * texel(face, i + 1, j + 1));
  }

  Rgb texel(std::size_t face, int x, int y) const {
    const V2i at(std::clamp(x, 0, side_ - 1), std::clamp(y, 0, side_ - 1));
    const Rgb colour = faces_[face]->texel(at);
    const int alpha = faces_[face]->alpha(at);
    if (alpha > 0 || is_black(colour))
      return colour * (255.0F / static_cast<float>(std::max(alpha, 1)));
    throw SceneError(
        fmt::format("{}: texel ({}, {}) is a colour over alpha 0; allowed in RGBD: 1 to 255",
                    faces_[face]->label(), at.x, at.y));
  }

  M44d to_cube_;
  int side_;
  std::array<const Texture*, 6> faces_{};
};

}  // namespace

std::unique_ptr<Environment> environment_of_cube(const SceneData& scene, const ThreadPool& pool) {
  const CubeRadiance cube(scene);
  const int height = 4 * scene.environment->side, width = 2 * height;
  std::vector<float> rgb(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  // Points of equal solid angle, at most pi / (8 n) apart.
  constexpr int points = 2;
  pool.for_each(height, [&](int y) {
    float* out = &rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width)];
    const double top = std::cos(std::numbers::pi * y / height),
                 bottom = std::cos(std::numbers::pi * (y + 1) / height);
    for (int x = 0; x < width; ++x) {
      Rgb sum(0, 0, 0);
      for (int i = 0; i < points * points; ++i) {
        const double cos = top + (bottom - top) * (i / points + 0.5) / points;
        const double sin = std::sqrt(std::max(0.0, 1 - cos * cos));
        const double phi = 2 * std::numbers::pi * ((x + (i % points + 0.5) / points) / width - 0.5);
        sum += cube.towards({sin * std::sin(phi), cos, -sin * std::cos(phi)});
      }
      for (int c = 0; c < 3; ++c) *out++ = sum[c] / (points * points);
    }
  });
  return std::make_unique<Environment>(width, height, std::move(rgb), scene.environment->intensity,
                                       0.0F);
}

}  // namespace lacuna
