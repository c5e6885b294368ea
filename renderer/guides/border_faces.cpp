#include "renderer/guides/border_faces.h"

#include <algorithm>
#include <span>

#include "renderer/core/direction_around.h"
#include "renderer/guides/face_paths.h"
#include "renderer/guides/named_region.h"

namespace lacuna {

void BorderFaceLight::prepare(const PrepareContext& context, const SurfaceLookup&) {
  const RegionLabels& labels = context.space.regions();
  label_ = &labels.label;
  borders_ = context.space.borders(BorderFaces::all);
  light_.assign(borders_.voxels.size(), 0.0);
  tables_.resize(labels.regions.size());
  boxes_.resize(labels.regions.size());
  lit_portal_faces_.resize(labels.regions.size());
  least_distance_ = settings_.least_distance * double(context.scene.bounds().size().length()) /
                    context.space.voxels().transform.voxel_size;
  if (settings_.through) through_ = named_region(*settings_.through, context).region;
  for (std::uint32_t r = 0; r < boxes_.size(); ++r) {
    for (std::uint64_t i = 0; i < borders_.faces(r); ++i) {
      const VoxelFace face = borders_.face(r, i);
      const Imath::V3i voxel = labels.label.voxel(face.voxel);
      boxes_[r].add(voxel);
      boxes_[r].add(voxel + Imath::V3i(face.normal()));
    }
  }
}

VoxelFace BorderFaceLight::sample_face(std::uint32_t region, const V3d& from, Rng& rng) const {
  const std::uint32_t own = sampled_region(region);
  const VoxelFace face = borders_.face(own, tables_[own].sample(rng));
  if (!has_thresholds()) return face;
  const std::uint32_t next = beyond(face);
  if (!is_replaced(face, next, from)) return face;
  return borders_.face(next, tables_[next].sample(rng));
}

void BorderFaceLight::add_parts(std::uint32_t region, const V3d& from, double weight,
                                FaceParts& parts) const {
  const std::uint32_t own = sampled_region(region);
  parts.add(boxes_[own], own, weight);
  const std::vector<LitPortalFace>& lit = lit_portal_faces_[own];
  const auto regions = static_cast<std::uint32_t>(tables_.size());
  for (std::size_t i = 0; i < lit.size();) {
    const std::uint32_t next = lit[i].beyond;
    double replaced = 0;  // Q_n
    for (; i < lit.size() && lit[i].beyond == next; ++i) {
      if (!is_suitable(lit[i].centre, lit[i].axis, from)) replaced += lit[i].probability;
    }
    if (replaced > 0 && !tables_[next].empty())
      parts.add(boxes_[next], regions + next, weight * replaced);
  }
}

double BorderFaceLight::probability(std::uint32_t part, const CrossedFace& face, std::uint32_t near,
                                    std::uint32_t far, const V3d& from) const {
  const auto regions = static_cast<std::uint32_t>(tables_.size());
  const bool from_first = part < regions;
  const std::uint32_t region = from_first ? part : part - regions;
  if (region != near) return 0;
  const VoxelFace own{static_cast<std::uint32_t>(label_->index(face.from)), face.side_of_from()};
  if (from_first && has_thresholds() && is_replaced(own, far, from)) return 0;
  return probability(region, own);
}

/// The thesis replaces a face because it is "too close, or located at a grazing angle" (10.4.2),
/// but states the opposite conditions: a distance "larger than d_t" and a cosine "greater than
/// o_t". With its d_t, about 1.5 voxels of its grid, these would keep only faces close to the
/// point, seen edge-on. This implements the stated reason.
bool BorderFaceLight::is_suitable(const V3d& centre, int axis, const V3d& from) const {
  const V3d apart = centre - from;
  const double distance = apart.length();
  return distance >= least_distance_ && std::abs(apart[axis]) >= settings_.least_cosine * distance;
}

std::uint32_t BorderFaceLight::beyond(const VoxelFace& face) const {
  const Imath::V3i voxel = label_->voxel(face.voxel) + Imath::V3i(face.normal());
  return in_grid(voxel, label_->size()) ? (*label_)(voxel) : no_region;
}

std::uint64_t BorderFaceLight::index(std::uint32_t region, const VoxelFace& face) const {
  const std::size_t group = 6 * std::size_t{region} + face.side;
  const auto begin = borders_.voxels.begin();
  const auto at =
      std::lower_bound(begin + static_cast<std::ptrdiff_t>(borders_.first[group]),
                       begin + static_cast<std::ptrdiff_t>(borders_.first[group + 1]), face.voxel);
  return static_cast<std::uint64_t>(at - begin) - first(region);
}

void BorderFaceLight::add(std::uint32_t region, const VoxelFace& face, double light) {
  if (std::isfinite(light)) light_[first(region) + index(region, face)] += light;
}

/// The irradiance of a face is pi times the mean of the radiance from directions sampled by their
/// cosine with its normal; pi, like the area, is the same for all.
Counters BorderFaceLight::begin(const IterationContext& context, int edges,
                                const GridTransform& transform) {
  if (learns_from_eye_paths() || begun_ == context.iteration + 1) return {};
  const auto ray = [&](std::size_t i, Rng& rng) -> Ray {
    const auto group = std::upper_bound(borders_.first.begin(), borders_.first.end(), i);
    const VoxelFace face{borders_.voxels[i],
                         static_cast<std::uint8_t>((group - borders_.first.begin() - 1) % 6)};
    const V2f at = rng.next2(), u = rng.next2();
    const V3d x = face.point(label_->voxel(face.voxel), double(at.x), double(at.y));
    const double versine = 1 - std::sqrt(1 - double(u.x));
    return {V3f(transform.to_world(x)), direction_around(V3f(face.normal()), versine, u.y)};
  };
  std::vector<float> found(light_.size(), 0.0F);
  Counters counters = arriving_light(context, std::max(1, edges - 1), ray, found);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::isfinite(found[i])) {
      light_[i] += double(found[i]);
    } else {
      ++counters.rejected;
    }
  }
  context.pool.for_each(static_cast<int>(tables_.size()),
                        [&](int r) { make_table(static_cast<std::uint32_t>(r)); });
  begun_ = context.iteration + 1;
  return counters;
}

void BorderFaceLight::make_table(std::uint32_t region) {
  tables_[region] = AliasTable(std::span(light_).subspan(first(region), borders_.faces(region)));
  if (has_thresholds()) find_lit_portal_faces(region);
}

void BorderFaceLight::find_lit_portal_faces(std::uint32_t region) {
  std::vector<LitPortalFace>& lit = lit_portal_faces_[region];
  lit.clear();
  const AliasTable& table = tables_[region];
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    const auto probability = double(table.pmf(i).value);
    if (!(probability > 0)) continue;
    const VoxelFace face = borders_.face(region, i);
    const std::uint32_t next = beyond(face);
    if (next != no_region) lit.push_back({centre(face), face.axis(), next, probability});
  }
  std::stable_sort(lit.begin(), lit.end(), [](const LitPortalFace& a, const LitPortalFace& b) {
    return a.beyond < b.beyond;
  });
}

void BorderFaceLight::save(ByteWriter& out) const {
  out.put(light_);
  if (!learns_from_eye_paths()) out.put(begun_);
}

void BorderFaceLight::load(ByteReader& in) {
  std::vector<double> light = in.get_vector<double>();
  if (light.size() != light_.size()) {
    throw std::runtime_error("saved face irradiance belongs to other borders");
  }
  light_ = std::move(light);
  if (!learns_from_eye_paths()) begun_ = in.get<std::uint64_t>();
  for (std::uint32_t r = 0; r < tables_.size(); ++r) make_table(r);
}

std::vector<std::pair<std::string, double>> BorderFaceLight::statistics() const {
  const auto lit = std::count_if(light_.begin(), light_.end(), [](double l) { return l > 0; });
  return {{"regions", static_cast<double>(tables_.size())},
          {"faces", static_cast<double>(light_.size())},
          {"faces_lit", static_cast<double>(lit)}};
}

}  // namespace lacuna
