#pragma once

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/contexts.h"
#include "renderer/path/record_tree.h"

namespace lacuna {

/// What a visibility sees of an iteration before its picture is made.
struct LightPass {
  const IterationContext& context;
  const VplContributions& terms;
  int max_depth;      ///< edges of an eye path
  float least_alpha;  ///< of the surfaces that lights shine on: Bsdf::is_vpl_receiver()
  BlockRange lights = {};
};

/// n_d / N: rays besides tests that a light's share of a shading point takes (Nabata et al., eq.
/// 13), one from the eye.
inline float eye_rays_per_light(const VplSet& lights) {
  return 1 / static_cast<float>(std::max<std::size_t>(1, lights.size()));
}

/// Shading points of the picture at which all virtual lights were tested: the visibility of each
/// light, a bit, and the variance of what they give (Nabata et al., 3.1). They are new in each
/// iteration, as the lights are.
class CachePoints {
 public:
  static constexpr int max_neighbours = 8;

  /// Whether the bits are kept too, or the variances alone.
  enum class Keep { variances, visibilities };

  CachePoints(int points, int neighbours, Keep keep)
      : wanted_(static_cast<std::size_t>(points)), neighbours_(neighbours), keep_(keep) {}

  /// Places and fills them. Throws std::runtime_error if the bits would take more than half of the
  /// free memory.
  Counters build(const LightPass& pass);

  /// The nearest cache points of a shading point.
  struct Near {
    int n = 0;
    std::array<std::uint32_t, max_neighbours> index{};
    std::array<float, max_neighbours> weight{};  ///< add up to 1
  };
  Near near(const ShadingPoint& at) const;

  /// Standard deviation, over the lights, of the luminance that they give `at`, visibility
  /// included; 0 where there is no cache point.
  float deviation(const ShadingPoint& at, const Near& near) const;
  /// The root of its mean square over the picture.
  float deviation() const { return static_cast<float>(std::sqrt(picture_variance_)); }
  /// q: how many of the nearest, by weight, see each light of `block`. Only where bits are kept.
  void expected(const Near& near, std::size_t block, Lanes& q) const;

  std::size_t size() const { return variances_.size(); }
  /// For the report.
  std::vector<std::pair<std::string, double>> statistics() const {
    return {{"cache_points", static_cast<double>(size())}};
  }

 private:
  /// Pixels, each with the share of the others that it stands for.
  std::vector<std::uint32_t> choose(const LightPass& pass, Counters& counters);
  void fill(const LightPass& pass, std::size_t point, const ShadingPoint& at, Counters& counters);

  std::size_t wanted_;
  int neighbours_;
  Keep keep_;
  RecordTree tree_;
  std::vector<SurfacePoint> points_;
  std::vector<double> variances_;  // of contributions over ShadingPoint::scale
  std::vector<double> scales_;     // ShadingPoint::scale
  std::vector<double> weights_;    // share of the picture's points that each stands for
  double picture_variance_ = 0;
  std::size_t blocks_ = 0;
  std::vector<std::uint64_t> bits_;  // of each point the words of all blocks
};

}  // namespace lacuna
