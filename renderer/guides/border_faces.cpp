#include "renderer/guides/border_faces.h"

#include <algorithm>
#include <span>

namespace lacuna {

void BorderFaceLight::prepare(const PrepareContext& context, const SurfaceLookup&) {
  const RegionLabels& labels = context.space.regions();
  label_ = &labels.label;
  borders_ = context.space.borders(BorderFaces::all);
  light_.assign(borders_.voxels.size(), 0.0);
  tables_.resize(labels.regions.size());
  boxes_.resize(labels.regions.size());
  for (std::uint32_t r = 0; r < boxes_.size(); ++r) {
    for (std::uint64_t i = 0; i < borders_.faces(r); ++i) {
      const VoxelFace face = borders_.face(r, i);
      const Imath::V3i voxel = labels.label.voxel(face.voxel);
      boxes_[r].add(voxel);
      boxes_[r].add(voxel + Imath::V3i(face.normal()));
    }
  }
}

std::uint64_t BorderFaceLight::index(std::uint32_t region, const VoxelFace& face) const {
  const std::size_t group = 6 * std::size_t{region} + face.side;
  const auto begin = borders_.voxels.begin();
  const auto at =
      std::lower_bound(begin + static_cast<std::ptrdiff_t>(borders_.first[group]),
                       begin + static_cast<std::ptrdiff_t>(borders_.first[group + 1]), face.voxel);
  return static_cast<std::uint64_t>(at - begin) - first(region);
}

void BorderFaceLight::accumulate(std::uint32_t region, const VoxelFace& face,
                                 const GuidingSample& sample, Accumulator& accumulator) const {
  const double light = double(sample.radiance) / double(sample.pdf.value);
  if (!std::isfinite(light)) return;
  accumulator.light[first(region) + index(region, face)] += light;
}

void BorderFaceLight::update(std::span<const Accumulator* const> accumulators,
                             const ThreadPool& pool) {
  for (const Accumulator* t : accumulators) {
    for (const auto& [face, light] : t->light) light_[face] += light;
  }
  pool.for_each(static_cast<int>(tables_.size()),
                [this](int r) { make_table(static_cast<std::uint32_t>(r)); });
}

void BorderFaceLight::make_table(std::uint32_t region) {
  tables_[region] = AliasTable(std::span(light_).subspan(first(region), borders_.faces(region)));
}

void BorderFaceLight::load(ByteReader& in) {
  std::vector<double> light = in.get_vector<double>();
  if (light.size() != light_.size()) {
    throw std::runtime_error("saved face irradiance belongs to other borders");
  }
  light_ = std::move(light);
  for (std::uint32_t r = 0; r < tables_.size(); ++r) make_table(r);
}

std::vector<std::pair<std::string, double>> BorderFaceLight::statistics() const {
  const auto lit = std::count_if(light_.begin(), light_.end(), [](double l) { return l > 0; });
  return {{"regions", static_cast<double>(tables_.size())},
          {"faces", static_cast<double>(light_.size())},
          {"faces_lit", static_cast<double>(lit)}};
}

}  // namespace lacuna
