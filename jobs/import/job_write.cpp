#include "jobs/import/job_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"

namespace lacuna {
namespace {

OrderedJson point(const V3d& p) { return {p.x, p.y, p.z}; }

bool is_mirrored(const M44d& m) {
  const V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]),
      z(m[2][0], m[2][1], m[2][2]);
  return x.cross(y).dot(z) < 0;
}

OrderedJson camera_of(const ImportedCamera& camera, std::vector<ImportNote>& notes) {
  const bool panorama = camera.projection == Projection::panorama;
  if (camera.aperture == 0 && !panorama) return camera.name;
  const M44d& m = camera.to_world;
  if (is_mirrored(m)) {
    notes.push_back({camera.place, camera.name, "approximated",
                     "its picture is mirrored, which a camera with a lens cannot be"});
  }
  const V3d position(m[3][0], m[3][1], m[3][2]), back(m[2][0], m[2][1], m[2][2]),
      up(m[1][0], m[1][1], m[1][2]);
  OrderedJson json = {{"type", panorama ? "panorama" : "perspective"},
                      {"position", point(position)},
                      {"target", point(position - back * camera.focus)},
                      {"up", point(up)}};
  if (panorama) return json;
  json["fov"] = camera.yfov * 180 / std::numbers::pi;
  json["aperture"] = camera.aperture;
  json["focus"] = camera.focus;
  if (camera.blades > 0) json["blades"] = camera.blades;
  return json;
}

}  // namespace

void write_job_of(const ImportedScene& scene, const std::optional<WrittenEnvironment>& environment,
                  const std::filesystem::path& folder, std::vector<ImportNote>& notes) {
  const std::string name = std::filesystem::absolute(folder / "").parent_path().filename().string();
  OrderedJson job = {{"scene", fmt::format("{}/scene.glb", name)}};
  if (!scene.lights.empty()) job["light_units"] = "radiometric";
  job["camera"] = camera_of(scene.cameras.at(0), notes);
  const ImportedPicture& picture = scene.picture;
  if (picture.crop_from) {
    job["resolution"] = picture.crop_size;
    job["crop"] = {{"of", picture.resolution}, {"from", *picture.crop_from}};
  } else {
    job["resolution"] = picture.resolution;
  }
  if (picture.tent_filter) job["pixel_filter"] = "tent";
  job["integrator"] = {{"type", "path"}};
  constexpr int no_limit = 1024;  // the largest that a job allows
  job["integrator"]["max_depth"] = std::min(no_limit, picture.max_depth.value_or(no_limit));
  if (environment) {
    job["environment"] = {{"file", fmt::format("{}/{}", name, environment->file)}};
    if (environment->scale != 1) job["environment"]["scale"] = environment->scale;
    if (environment->rotation != 0) job["environment"]["rotation"] = environment->rotation;
  }
  write_file_atomically(folder / "job.json", document_text(job));
}

}  // namespace lacuna
