#include "renderer/guides/named_region.h"

#include <fmt/format.h>

#include "renderer/core/scene_error.h"

namespace lacuna {

NamedRegion named_region(const std::array<double, 3>& through, const PrepareContext& context) {
  const Voxels& voxels = context.space.voxels();
  const Grid3<std::uint32_t>& label = context.space.regions().label;
  const V3d at = V3d(through[0], through[1], through[2]) - context.scene.data().origin;
  const V3d point = voxels.transform.to_grid(at);
  const auto refuse = [&](const std::string& why) {
    throw SceneError(fmt::format("guide: \"through\" [{}, {}, {}] is not in the empty space: {}",
                                 through[0], through[1], through[2], why));
  };
  const auto voxel = voxel_at(point, label.size());
  if (!voxel) refuse("it lies outside the scene's grid");
  if (voxels.scene.get(*voxel)) {
    refuse(fmt::format("a surface intersects its voxel, whose side is {:.6g}",
                       voxels.transform.voxel_size));
  }
  const std::uint32_t region = label(*voxel);
  if (region == no_region)
    refuse("neither the camera nor a light is in its connected part of the empty space");
  return {point, region};
}

}  // namespace lacuna
