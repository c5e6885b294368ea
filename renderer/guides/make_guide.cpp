#include "renderer/guides/make_guide.h"

#include "renderer/guides/border_faces.h"
#include "renderer/guides/face_directions.h"
#include "renderer/guides/portal_faces.h"
#include "renderer/guides/sd_tree.h"
#include "renderer/guides/skeleton_directions.h"

namespace lacuna {

namespace {

struct Make {
  std::unique_ptr<Directions> operator()(const BsdfGuideSettings&) const { return nullptr; }
  std::unique_ptr<Directions> operator()(const SkeletonGuideSettings& s) const {
    return std::make_unique<SkeletonDirections>(s);
  }
  std::unique_ptr<Directions> operator()(const PortalsGuideSettings& s) const {
    return std::make_unique<FaceDirections<PortalFaces>>(s, PortalFaces(s));
  }
  std::unique_ptr<Directions> operator()(const FaceIrradianceGuideSettings& s) const {
    return std::make_unique<FaceDirections<BorderFaceLight>>(s, BorderFaceLight());
  }
  std::unique_ptr<Directions> operator()(const SdTreeGuideSettings& s) const {
    return std::make_unique<SdTree>(s);
  }
};

}  // namespace

std::unique_ptr<Directions> make_directions(const GuideSettings& settings) {
  return std::visit(Make{}, settings);
}

}  // namespace lacuna
