#include "jobs/import/environment_write.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/storage/atomic_file.h"
#include "jobs/import/equal_area.h"
#include "jobs/import/linear_picture.h"
#include "renderer/core/scene_error.h"
#include "renderer/images/exr_write.h"

namespace lacuna {
namespace {

V3d row(const M44d& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

/// Whether the orientation is a rotation about y, by `degrees`: the picture's centre (+x) shows -z
/// turned counter-clockwise seen from above, its left (+y) -x, its top (+z) +y.
bool is_about_y(const M44d& to_world, double& degrees) {
  const V3d x = row(to_world, 0).normalized();
  const double angle = std::atan2(-x.x, -x.z), s = std::sin(angle), c = std::cos(angle);
  const double off = std::max({(x - V3d(-s, 0, -c)).length(),
                               (row(to_world, 1).normalized() - V3d(-c, 0, s)).length(),
                               (row(to_world, 2).normalized() - V3d(0, 1, 0)).length()});
  constexpr double unseen = 1e-5;  // radians: far below a texel
  degrees = angle * 180 / std::numbers::pi;
  return off < unseen;
}

/// Bilinear; to the left and right the picture goes on with its other end.
Rgb lookup(const LinearPicture& p, const V2d& uv) {
  const double x = uv.x * p.width - .5, y = uv.y * p.height - .5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const auto at = [&](int i, int j) {
    return p.at(((x0 + i) % p.width + p.width) % p.width, std::clamp(y0 + j, 0, p.height - 1));
  };
  return (at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) +
         (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy;
}

/// Where the picture has a direction of its own coordinates; row 0 at v = 0.
V2d place_of(const V3d& p, ImportedEnvironment::Layout layout) {
  if (layout == ImportedEnvironment::Layout::equal_area) {
    return equal_area_square({-p.x, p.y, p.z});
  }
  return {.5 - std::atan2(p.y, p.x) / (2 * std::numbers::pi),
          std::acos(std::clamp(p.z, -1.0, 1.0)) / std::numbers::pi};
}

/// The picture as seen with `rotation` 0, at twice its resolution.
LinearPicture turned(const LinearPicture& from, const ImportedEnvironment& e) {
  constexpr int most = 8192;
  LinearPicture out;
  out.width = std::max(from.width, std::min(most, 2 * from.width));
  out.height = out.width / 2;
  const M44d to_picture = e.to_world.inverse();
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const double phi = 2 * std::numbers::pi * ((x + .5) / out.width - .5),
                   theta = std::numbers::pi * (y + .5) / out.height;
      const V3d w(std::sin(theta) * std::sin(phi), std::cos(theta),
                  -std::sin(theta) * std::cos(phi));
      V3d p;
      to_picture.multDirMatrix(w, p);
      out.pixels.push_back(lookup(from, place_of(p.normalized(), e.layout)));
    }
  }
  return out;
}

void write_picture(const std::filesystem::path& file, const LinearPicture& picture) {
  ExrPicture exr{picture.width, picture.height, {{"", {"R", "G", "B"}, {}}}, {}, {}};
  for (const Rgb& p : picture.pixels) {
    for (int c = 0; c < 3; ++c) exr.layers[0].values.push_back(double(p[c]));
  }
  write_exr(file, exr);
}

}  // namespace

WrittenEnvironment write_environment(const ImportedEnvironment& e,
                                     const std::filesystem::path& folder,
                                     std::vector<ImportNote>& notes) {
  if (e.daylight) {
    write_picture(folder / "environment.exr",
                  daylight_picture(*e.daylight, e.to_world, e.daylight_width));
    return {"environment.exr", 1, 0};
  }
  if (e.file.empty()) {
    write_picture(folder / "environment.exr", {2, 1, {e.scale, e.scale}});
    return {"environment.exr", 1, 0};
  }
  ImportedTexture source;
  source.place = e.place;
  source.file = e.file;
  LinearPicture picture = linear_picture(source);
  const bool equirectangular = e.layout == ImportedEnvironment::Layout::equirectangular;
  double rotation = 0;
  const bool about_y = equirectangular && is_about_y(e.to_world, rotation);
  const bool grey = e.scale.x == e.scale.y && e.scale.y == e.scale.z;
  const bool negative = std::any_of(picture.pixels.begin(), picture.pixels.end(),
                                    [](const Rgb& p) { return p.x < 0 || p.y < 0 || p.z < 0; });
  std::string kind = e.file.extension().string();
  if (about_y && grey && !negative && (kind == ".exr" || kind == ".hdr")) {
    const std::string name = "environment" + kind;
    constexpr std::size_t most = std::size_t{4} << 30;
    write_file_atomically(folder / name, read_file(std::filesystem::canonical(e.file), most),
                          false);
    return {name, double(e.scale.x), rotation};
  }
  for (Rgb& p : picture.pixels) {
    for (int c = 0; c < 3; ++c) p[c] = std::max(0.0F, p[c] * e.scale[c]);
  }
  const std::string name = "environment map " + e.file.filename().string();
  if (negative) notes.push_back({e.place, name, "approximated", "its negative values become 0"});
  if (!about_y) {
    picture = turned(picture, e);
    notes.push_back({e.place, name, "approximated",
                     equirectangular ? "resampled: its orientation is not a rotation about y, "
                                       "which is what a job can say"
                                     : "resampled from a map of equal areas"});
  }
  write_picture(folder / "environment.exr", picture);
  return {"environment.exr", 1, about_y ? rotation : 0};
}

}  // namespace lacuna
