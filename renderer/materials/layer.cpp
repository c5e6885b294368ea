#include "renderer/materials/layer.h"

#include <map>
#include <memory>

#include "renderer/materials/facets.h"
#include "renderer/materials/roughness_table.h"

namespace lacuna {
namespace {

/// The mean of Schlick's weight over visible normals on a regular grid, each weighted by its
/// unshadowed fraction.
float mean_over_facets(float cos, float alpha) {
  if (alpha < ggx_min_alpha) return schlick_weight(cos);
  cos = std::max(cos, 1e-4F);
  constexpr int n = 24;
  const V3f wo(std::sqrt(1 - cos * cos), 0, cos);
  double weighted = 0, total = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const V2f u((static_cast<float>(i) + 0.5F) / n, (static_cast<float>(j) + 0.5F) / n);
      const V3f m = ggx_sample_visible(wo, alpha, u);
      const float cos_i = reflect(wo, m).z;
      if (cos_i <= 0) continue;
      const double g = ggx_g2_over_4cos(cos, cos_i, alpha);
      weighted += g * schlick_weight(dot(wo, m));
      total += g;
    }
  }
  return static_cast<float>(weighted / total);
}

RoughnessTable& mean_weight_table() {
  static RoughnessTable result(mean_over_facets);
  return result;
}

/// What one facet, visible from `wo`, transmits past the others to the other side of z.
double transmitted_by(const Facets& facets, const V3f& wo, const V3f& m, float ior) {
  const float cos = dot(wo, m);
  if (!(cos > 0)) return 0;
  const Fresnel f = fresnel_dielectric(cos, ior);
  if (f.total) return 0;
  const V3f wi = refract(wo, m, ior, f.cos_t);
  return wi.z < 0 ? double(facets.shadowed(1 - f.reflectance, wo, wo.z, wi, -wi.z)) : 0.0;
}

/// The fraction of light that facets transmit from outside, once scattered: the mean over visible
/// normals, by the midpoint rule over squares around the centre of the unit square of their
/// numbers. These are close to each other at its edge, where the slopes grow without bounds.
float transmitted(float cos, float alpha, float ior, FacetShape shape) {
  if (alpha < ggx_min_alpha) return 1 - fresnel_dielectric(cos, ior).reflectance;
  cos = std::max(cos, 1e-4F);
  const V3f wo(std::sqrt(1 - cos * cos), 0, cos);
  const Facets facets({0, 0, 1}, alpha, alpha, V3f(1, 0, 0), shape);
  constexpr int squares = 24, per_side = squares / 2;
  const auto radius = [](double t) { return 1 - (1 - t) * (1 - t) * (1 - t); };
  const auto from_centre = [](double x) { return static_cast<float>(0.5 + 0.5 * x); };
  double sum = 0;
  for (int i = 0; i < squares; ++i) {
    const double r = radius((i + 0.5) / squares);
    const double inner = radius(double(i) / squares), outer = radius((i + 1.0) / squares);
    double on_square = 0;
    for (int j = 0; j < per_side; ++j) {
      const double x = r * (2 * (j + 0.5) / per_side - 1);
      for (const auto& [a, b] : {std::pair(r, x), {-r, x}, {x, r}, {x, -r}}) {
        const V3f m = facets.sample(wo, {from_centre(a), from_centre(b)});
        on_square += transmitted_by(facets, wo, m, ior) / (4 * per_side);
      }
    }
    sum += (outer * outer - inner * inner) * on_square;
  }
  return static_cast<float>(sum);
}

/// The table of 1 - transmitted(). Each thread remembers the last one, because hits ask for it.
RoughnessTable& dielectric_table(float ior, FacetShape shape) {
  using Key = std::pair<float, FacetShape>;
  thread_local std::pair<Key, RoughnessTable*> last{};
  const Key key(ior, shape);
  if (last.second != nullptr && last.first == key) return *last.second;
  static std::mutex mutex;
  static std::map<Key, std::unique_ptr<RoughnessTable>> tables;
  const std::lock_guard lock(mutex);
  std::unique_ptr<RoughnessTable>& table = tables[key];
  if (!table) {
    table = std::make_unique<RoughnessTable>(
        [=](float cos, float alpha) { return 1 - transmitted(cos, alpha, ior, shape); });
  }
  last = {key, table.get()};
  return *table;
}

/// Integral of Schlick's weight times 2 cos over [0, 1].
constexpr float smooth_hemisphere = 1.0F / 21;

}  // namespace

Layer::Layer(float f0, float f90, float alpha) : f0_(f0), f90_(f90) {
  float mean_weight = smooth_hemisphere;
  if (alpha != 0) mean_weight = use(mean_weight_table(), alpha);
  const float mean = let_through(mean_weight);
  norm_ = mean > 0 ? 1 / mean : 0;
}

Layer::Layer(float ior, const Roughness& roughness) : f90_(1), ior_(ior) {
  const V2f widths = roughness.widths();
  double mean_weight = mean_dielectric_reflectance(double(ior));
  if (widths.y > 0) {
    mean_weight =
        double(use(dielectric_table(ior, roughness.shape), std::sqrt(widths.x * widths.y)));
  }
  norm_ = mean_weight < 1 ? static_cast<float>(1 / (1 - mean_weight)) : 0;
}

/// The mean over the hemisphere of `table` at `alpha`.
float Layer::use(RoughnessTable& table, float alpha) {
  row_ = RoughnessTable::row(alpha);
  table.need(row_);
  table_ = &table;
  return table.hemisphere(row_);
}

MeanWeights::MeanWeights(const Layer& layer) : smooth_(layer.row_ < 0) {
  if (!smooth_) layer.table_->columns_at(layer.row_, v_);
}

Float8 MeanWeights::at(Float8 cos) const {
  if (smooth_) return schlick_weight(cos);
  const Float8 x = sqrt(min(Float8(1), max(Float8(0), cos))) * float(columns - 1);
  const Int8 column = min(truncate(x), Int8(columns - 2));
  const Float8 low = gather(v_.data(), column), high = gather(v_.data() + 1, column);
  return low + (x - to_float(column)) * (high - low);
}

float Layer::mean_weight(float cos) const {
  if (row_ >= 0) return table_->at(row_, cos);
  return ior_ == 0 ? schlick_weight(cos) : fresnel_dielectric(cos, ior_).reflectance;
}

}  // namespace lacuna
