#include "renderer/guides/aimed_lobes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "renderer/core/direction_around.h"

namespace lacuna {

namespace {

/// Concentration of the initial lobes, which are distributed evenly over the sphere.
constexpr double initial_concentration = 8;
/// Pseudo-samples of each lobe (a prior): without a direction, which keeps lobes of few samples
/// wide, and of its mixture weight, so that no lobe vanishes.
constexpr double prior_directions = 0.02, prior_share = 0.05;
/// Responsibility floor: the smallest density per steradian of each lobe in the E-step. All lobes
/// share light for which none has a density. A much smaller floor makes learning slow.
constexpr float responsibility_floor = 1e-6F;
/// The widest and the narrowest lobe (one degree).
constexpr double min_concentration = 1e-2, max_concentration = 5000;
/// The largest share of one sample in the total weight: one rare path must not dominate all lobes.
/// The limit is iterated until it changes by less than a tenth.
constexpr double largest_share = 0.1, convergence_ratio = 0.9;
/// Steps of expectation maximisation for the first batch and for later ones.
constexpr int first_em_steps = 8, later_em_steps = 2;
/// A lobe with fewer samples keeps its parameters.
constexpr double least_samples = 1e-3;

double length_of(const V3d& v) { return std::sqrt(v.dot(v)); }

}  // namespace

std::optional<V3f> AimedLobes::sample(const V3f& x, Rng::FinePoint u) const {
  double left = static_cast<double>(u.x) * 0x1p-64;
  std::size_t i = 0;
  while (i + 1 < count && left >= lobes_[i].share) left -= lobes_[i++].share;
  const Lobe& lobe = lobes_[i];
  left = std::min(left / lobe.share, 1 - 0x1p-53);
  const V3f d = V3f(lobe.aim.axis) - (x - pivot_) * static_cast<float>(lobe.aim.inverse_distance);
  const float length = std::sqrt(dot(d, d));
  if (!(length > 0)) return std::nullopt;
  // exp(kappa (cos - 1)) is uniform between its ends. Near the axis 1 - cos is more precise than
  // the cosine.
  const double k = lobe.concentration;
  const double versine = std::min(-std::log1p(left * std::expm1(-2 * k)) / k, 2.0);
  return direction_around(d / length, versine, u.point().y);
}

AimedLobes::AimedLobes(const V3f& pivot, std::span<const Target> targets) {
  if (targets.empty()) return;
  std::vector<Target> heaviest(targets.begin(), targets.end());
  std::ranges::stable_sort(heaviest, std::ranges::greater{}, &Target::weight);
  initialise(pivot);
  double all = 0;
  for (std::size_t i = 0; i < std::min(count, heaviest.size()); ++i) all += heaviest[i].weight;
  for (std::size_t i = 0; i < count; ++i) {
    Lobe& lobe = lobes_[i];
    lobe.share = prior_share;
    if (i >= heaviest.size()) continue;
    const V3d to = V3d(heaviest[i].at) - V3d(pivot);
    const double length = length_of(to);
    if (length > 0) lobe.aim = {to / length, 1 / length};
    lobe.share += heaviest[i].weight / all;
  }
  double sum = 0;
  for (const Lobe& l : lobes_) sum += l.share;
  for (Lobe& l : lobes_) l.share /= sum;
  pack();
}

/// The samples that gathered light, weighted by the irradiance that each estimates.
std::vector<AimedLobes::ArrivingLight> AimedLobes::arriving_light(
    std::span<const TrainingSample> samples) {
  std::vector<ArrivingLight> found;
  for (const TrainingSample& s : samples) {
    const float weight = s.pdf > 0 ? s.radiance * s.cosine / s.pdf : 0.0F;
    if (weight > 0 && std::isfinite(weight)) found.push_back({s.x, s.w, s.distance, weight});
  }
  return found;
}

void AimedLobes::learn(std::span<const TrainingSample> all) {
  const std::vector<ArrivingLight> batch = arriving_light(all);
  if (batch.empty()) return;
  V3d positions(0, 0, 0);
  for (const ArrivingLight& l : batch) positions += V3d(l.x);
  const bool first = !(statistics_.weight > 0);
  if (empty()) initialise(V3f(positions / double(batch.size())));
  position_sum_ += positions;
  position_count_ += double(batch.size());

  const double most = weight_limit(batch);
  std::vector<LobeObservation> samples;
  samples.reserve(batch.size());
  for (const ArrivingLight& l : batch) {
    samples.push_back(observe(l));
    // At most 1, so that sums of floats do not overflow.
    samples.back().weight = static_cast<float>(std::min(double(l.weight) / most, 1.0));
  }
  Statistics sum;
  for (int k = 0; k < (first ? first_em_steps : later_em_steps); ++k) {
    sum = statistics_;
    sum.add(expectation(samples), most);
    maximise(sum);
  }
  statistics_ = sum;
}

/// The weight to which larger ones are clamped: the fraction largest_share of the total of clamped
/// weights. At least the smallest weight, if the first batch is too small for that.
double AimedLobes::weight_limit(std::span<const ArrivingLight> batch) const {
  double least = HUGE_VAL, most = 0;
  for (const ArrivingLight& l : batch) {
    least = std::min(least, double(l.weight));
    most = std::max(most, double(l.weight));
  }
  const double floor = statistics_.weight > 0 ? 0 : least;
  for (;;) {
    double all = statistics_.weight;
    for (const ArrivingLight& l : batch) all += std::min(double(l.weight), most);
    const double lower = std::max(largest_share * all, floor);
    if (lower > convergence_ratio * most) return most;
    most = lower;
  }
}

void AimedLobes::initialise(const V3f& pivot) {
  pivot_ = pivot;
  initialised_ = true;
  constexpr double golden_angle = 2.39996322972865332;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * double(i) + 1) / double(count), r = std::sqrt(1 - z * z);
    const double phi = golden_angle * double(i);
    lobes_[i] = {.aim = {{r * std::cos(phi), r * std::sin(phi), z}, 0},
                 .concentration = initial_concentration,
                 .share = 1.0 / double(count)};
  }
  pack();
}

AimedLobes::LobeObservation AimedLobes::observe(const ArrivingLight& light) const {
  LobeObservation distant{light.w, light.w, 0, 0};
  if (!std::isfinite(light.distance)) return distant;
  const V3d to = V3d(light.x) - V3d(pivot_) + V3d(light.w) * double(light.distance);
  const double length = length_of(to), inverse = 1 / length;
  if (!(length > 0) || !std::isfinite(inverse)) return distant;
  return {V3f(to * inverse), light.w, static_cast<float>(inverse), 0};
}

void AimedLobes::Statistics::add(const Statistics& other, double scale) {
  weight += other.weight * scale;
  squares += other.squares * scale * scale;
  for (std::size_t i = 0; i < count; ++i) {
    lobes[i].weight += other.lobes[i].weight * scale;
    lobes[i].inverse_distance += other.lobes[i].inverse_distance * scale;
    lobes[i].from_pivot += other.lobes[i].from_pivot * scale;
    lobes[i].from_position += other.lobes[i].from_position * scale;
  }
}

AimedLobes::Statistics AimedLobes::expectation(std::span<const LobeObservation> batch) const {
  Statistics statistics;
  Float8 weight, inverse;
  Float8x3 from_pivot, from_position;
  const Mask8 aimed = mask_from_bits(packed_.aimed);
  const V3f pivot(0, 0, 0);
  const Float8 least = responsibility_floor;
  for (const LobeObservation& s : batch) {
    const Float8x3 at_pivot{s.from_pivot.x, s.from_pivot.y, s.from_pivot.z};
    const Float8x3 at_position{s.from_position.x, s.from_position.y, s.from_position.z};
    // Lobes of constant direction use the direction from the sample's position.
    const Float8 part = max(packed_.densities(pivot, select(aimed, at_pivot, at_position)), least);
    const Float8 own = part * (s.weight / reduce_add(part));
    weight = weight + own;
    inverse = inverse + own * s.inverse_distance;
    from_pivot = from_pivot + at_pivot * own;
    from_position = from_position + at_position * own;
    statistics.weight += double(s.weight);
    statistics.squares += double(s.weight) * double(s.weight);
  }
  alignas(32) std::array<std::array<float, count>, 8> sums;
  const std::array<Float8, 8> all{weight,       inverse,         from_pivot.x,    from_pivot.y,
                                  from_pivot.z, from_position.x, from_position.y, from_position.z};
  for (std::size_t k = 0; k < all.size(); ++k) all[k].store(sums[k].data());
  for (std::size_t i = 0; i < count; ++i) {
    statistics.lobes[i] = {double(sums[0][i]), double(sums[1][i]),
                           V3d(sums[2][i], sums[3][i], sums[4][i]),
                           V3d(sums[5][i], sums[6][i], sums[7][i])};
  }
  return statistics;
}

void AimedLobes::maximise(const Statistics& statistics) {
  // Effective sample size: the number of samples of equal weight with the same information.
  const double samples = statistics.weight * (statistics.weight / statistics.squares);
  for (std::size_t i = 0; i < count; ++i) {
    const Statistics::LobeStatistics& of = statistics.lobes[i];
    Lobe& lobe = lobes_[i];
    const double own = samples * (of.weight / statistics.weight);
    lobe.share = (own + prior_share) / (samples + double(count) * prior_share);
    const double at_pivot = length_of(of.from_pivot), at_position = length_of(of.from_position);
    const double length = std::max(at_pivot, at_position);
    if (!(own > least_samples) || !(length > 0)) continue;
    // The longer mean vector belongs to the narrower lobe.
    lobe.aimed = at_pivot >= at_position;
    if (lobe.aimed) {
      lobe.aim = {of.from_pivot / length, of.inverse_distance / of.weight};
    } else {
      lobe.aim = {of.from_position / length, 0};
    }
    // The concentration from the mean vector's length (Banerjee et al. 2005, 4.4).
    const double r = std::min(length / of.weight, 1.0) * own / (own + prior_directions);
    lobe.concentration =
        std::clamp(r * (3 - r * r) / (1 - r * r), min_concentration, max_concentration);
  }
  pack();
}

void AimedLobes::pack() {
  constexpr double ln2 = 0.693147180559945309;
  packed_.aimed = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Lobe& lobe = lobes_[i];
    const double k = lobe.concentration;
    packed_.x[i] = static_cast<float>(lobe.aim.axis.x);
    packed_.y[i] = static_cast<float>(lobe.aim.axis.y);
    packed_.z[i] = static_cast<float>(lobe.aim.axis.z);
    packed_.inverse_distance[i] = static_cast<float>(lobe.aim.inverse_distance);
    packed_.aimed |= lobe.aimed ? 1U << i : 0U;
    packed_.exponent_scale[i] = static_cast<float>(-k / (2 * ln2));
    packed_.peak[i] = static_cast<float>(lobe.share * k / (2 * double(pi) * -std::expm1(-2 * k)));
  }
}

void AimedLobes::next_round() {
  if (position_count_ > 0) move_pivot(V3f(position_sum_ / position_count_));
  position_sum_ = V3d(0, 0, 0);
  position_count_ = 0;
  Statistics half;
  half.add(statistics_, 0.5);
  half.squares = statistics_.squares / 2;  // half the number of samples
  statistics_ = half;
}

void AimedLobes::Aim::move(const V3d& d) {
  const V3d to = axis - d * inverse_distance;
  const double length = length_of(to);
  if (!(length > 0)) return;
  axis = to / length;
  inverse_distance /= length;
}

void AimedLobes::move_pivot(const V3f& to) {
  const V3d by = V3d(to) - V3d(pivot_);
  pivot_ = to;
  for (std::size_t i = 0; i < count; ++i) {
    lobes_[i].aim.move(by);
    Statistics::LobeStatistics& of = statistics_.lobes[i];
    const double length = length_of(of.from_pivot);
    if (!(length > 0) || !(of.weight > 0)) continue;
    Aim mean{of.from_pivot / length, of.inverse_distance / of.weight};
    mean.move(by);
    of.from_pivot = mean.axis * length;
    of.inverse_distance = mean.inverse_distance * of.weight;
  }
  pack();
}

/// Calls `use` for each number of the state, in a fixed order.
template <class Self, class Use>
void AimedLobes::for_each_number(Self& self, const Use& use) {
  const auto each = [&use](auto&... all) { (use(all), ...); };
  each(self.initialised_, self.pivot_.x, self.pivot_.y, self.pivot_.z);
  each(self.position_sum_.x, self.position_sum_.y, self.position_sum_.z, self.position_count_);
  for (auto& l : self.lobes_) {
    each(l.aim.axis.x, l.aim.axis.y, l.aim.axis.z, l.aim.inverse_distance);
    each(l.concentration, l.share, l.aimed);
  }
  each(self.statistics_.weight, self.statistics_.squares);
  for (auto& l : self.statistics_.lobes) {
    each(l.weight, l.inverse_distance, l.from_pivot.x, l.from_pivot.y, l.from_pivot.z);
    each(l.from_position.x, l.from_position.y, l.from_position.z);
  }
}

void AimedLobes::save(ByteWriter& out) const {
  for_each_number(*this, [&out](const auto& v) { out.put(double(v)); });
}

void AimedLobes::load(ByteReader& in) {
  bool valid = true;
  for_each_number(*this, [&](auto& v) {
    v = static_cast<std::remove_reference_t<decltype(v)>>(in.get<double>());
    valid = valid && std::isfinite(double(v));
  });
  for (const Lobe& l : lobes_) {
    valid =
        valid && l.concentration > 0 && l.share >= 0 && l.share <= 1 && l.aim.inverse_distance >= 0;
  }
  if (!valid || !(statistics_.weight >= 0)) throw std::runtime_error("saved lobes are not valid");
  pack();
}

}  // namespace lacuna
