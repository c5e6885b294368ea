#include "renderer/guides/make_guide.h"

#include "renderer/guides/skeleton_directions.h"

namespace lacuna {

namespace {

struct Make {
  std::unique_ptr<Directions> operator()(const BsdfGuideSettings&) const { return nullptr; }
  std::unique_ptr<Directions> operator()(const SkeletonGuideSettings& s) const {
    return std::make_unique<SkeletonDirections>(s);
  }
};

}  // namespace

std::unique_ptr<Directions> make_directions(const GuideSettings& settings) {
  return std::visit(Make{}, settings);
}

}  // namespace lacuna
