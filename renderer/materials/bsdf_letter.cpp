#include "renderer/materials/bsdf.h"

namespace lacuna {

bool Bsdf::mostly_diffuse(const V3f& to_eye, const V3f& to_light) const {
  if (lobes_->kind == Lobes::Kind::lambert) return true;
  const bool through = lobes_->further && !is_black(lobes_->further->diffuse_through);
  if (!lobes_->has_diffuse() && !through) return false;
  if (lobes_->interface.smooth() && !lobes_->further) return true;
  Lobes others = *lobes_;
  others.diffuse = Rgb(0, 0, 0);
  if (others.further) others.further->diffuse_through = Rgb(0, 0, 0);
  Bsdf without = *this;
  without.lobes_ = HeldLobes(others);
  return 2 * luminance(without.eval(to_eye, to_light, Transport::radiance)) <=
         luminance(eval(to_eye, to_light, Transport::radiance));
}

}  // namespace lacuna
