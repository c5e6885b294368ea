#include "renderer/guides/make_guide.h"

namespace lacuna {

namespace {

struct Make {
  std::unique_ptr<Directions> operator()(const BsdfGuideSettings&) const { return nullptr; }
};

}  // namespace

std::unique_ptr<Directions> make_directions(const GuideSettings& settings) {
  return std::visit(Make{}, settings);
}

}  // namespace lacuna
