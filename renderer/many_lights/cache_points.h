#pragma once

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/contexts.h"
#include "renderer/path/record_tree.h"
#include "renderer/settings/visibility_settings.h"

namespace lacuna {

/// The inputs of Visibility::begin(): the lights of an iteration, before its picture is rendered.
struct LightPass {
  const IterationContext& context;
  const VplContributions& terms;
  int max_depth;      ///< edges of an eye path
  float least_alpha;  ///< Bsdf::is_vpl_receiver()
  BlockRange lights = {};
  std::size_t sampled = ~std::size_t{0};  ///< lights gathered per shading point, if not all
  bool equal = true;                      ///< lights are sampled with equal probabilities

  std::size_t gathered() const { return std::min(sampled, terms.lights().size()); }
};

/// n_d / N (Nabata et al., eq. 13): eye rays per gathered light, with one eye ray per shading
/// point.
inline float eye_rays_per_light(const LightPass& pass) {
  return 1 / static_cast<float>(std::max<std::size_t>(1, pass.gathered()));
}

/// Shading points at which the visibility of virtual lights is tested: they store one bit of
/// visibility per light, and the variance of the lights' contributions (Nabata et al., 3.1). They
/// are new in each iteration, like the lights. If only some lights are gathered per shading point,
/// the number of cache points is limited so that their tests are at most a quarter of those of the
/// gathered lights.
class CachePoints {
 public:
  static constexpr int max_neighbours = 8;

  /// The stored data: only variances, or also the visibility bits.
  enum class Keep { variances, visibilities };

  /// `tested`: used with Keep::visibilities only.
  CachePoints(int points, int neighbours, Keep keep, CacheLights tested = CacheLights::lit)
      : wanted_(static_cast<std::size_t>(points)),
        neighbours_(neighbours),
        keep_(keep),
        all_(keep == Keep::visibilities && tested == CacheLights::all) {}

  /// Selects the points and tests the lights at them. Throws MemoryLimitError if there is no memory
  /// for the bits. If lights are sampled by importance, the variance of their contributions is not
  /// that of the estimate: it stays unknown.
  Counters build(const LightPass& pass);

  /// The nearest cache points of a shading point.
  struct Neighbours {
    int n = 0;
    std::array<std::uint32_t, max_neighbours> index{};
    std::array<float, max_neighbours> weight{};  ///< sum is 1
  };
  Neighbours nearest(const ShadingPoint& at) const;

  /// Standard deviation of the lights' contributions (luminance, with visibility) to `at`: `of` the
  /// point itself, of its cache points, or the root mean square over the picture. 0 if it is
  /// unknown or there is no cache point. `neighbours`: of `at`; not used for the picture.
  float deviation(VarianceOf of, const ShadingPoint& at, const Neighbours& neighbours) const;
  /// q: the weighted mean visibility of each light of `block` over the nearest points at which it
  /// was tested: with CacheLights::lit, those at which the light has a contribution. Returns a mask
  /// of the lights tested at some point; q of the others is 0. Requires Keep::visibilities.
  std::uint64_t expected(const Neighbours& neighbours, std::size_t block, Lanes& q) const;

  std::size_t size() const { return variances_.size(); }
  /// For the report.
  std::vector<std::pair<std::string, double>> statistics() const {
    return {{"cache_points", static_cast<double>(size())}};
  }

 private:
  /// The largest number of cache points for a picture with this number of shading points.
  std::size_t affordable(const LightPass& pass, std::size_t shading_points) const;
  /// Selects the pixels of the cache points and sets weights_.
  std::vector<std::uint32_t> choose(const LightPass& pass, Counters& counters);
  void fill(const LightPass& pass, std::size_t point, const ShadingPoint& at, Counters& counters);

  std::size_t wanted_;
  int neighbours_;
  Keep keep_;
  bool all_;  // tests lights without a contribution, too
  RecordTree tree_;
  std::vector<SurfacePoint> points_;
  std::vector<double> variances_;  // of contributions over ShadingPoint::scale
  std::vector<double> scales_;     // ShadingPoint::scale
  std::vector<double> weights_;    // fraction of the picture's shading points in its cluster
  double picture_variance_ = 0;
  std::size_t blocks_ = 0;
  // For each point and block: which lights were tested, and which of these are visible.
  struct VisibilityBits {
    std::uint64_t tested = 0, visible = 0;
  };
  std::vector<VisibilityBits> visibility_;
};

}  // namespace lacuna
