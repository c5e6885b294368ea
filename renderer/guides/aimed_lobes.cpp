#include "renderer/guides/aimed_lobes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "renderer/core/direction_around.h"

namespace lacuna {

namespace {

/// Lobes begin so concentrated, evenly over the sphere.
constexpr double first_concentration = 8;
/// Samples that each lobe is given in advance: without a direction, which keeps lobes of few
/// samples wide, and of its share, so that none is lost.
constexpr double given_directions = 0.02, given_share = 0.05;
/// The least density per steradian of each lobe where light is shared out: what none of them has a
/// density for, all of them turn to. Much less, and it is learned slowly.
constexpr float stray_density = 1e-6F;
/// The widest and the narrowest lobe: of a degree.
constexpr double least_concentrated = 1e-2, most_concentrated = 5000;
/// The largest share of one sample in all: one rare path must not carry all lobes away. It is found
/// by repeated reduction, until that changes it by less than a tenth.
constexpr double most_of_all = 0.1, near_enough = 0.9;
/// Of expectation and maximisation, of the first batch and of later ones.
constexpr int first_fits = 8, later_fits = 2;
/// Samples of a lobe below which it stays as it is.
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
  begin(pivot);
  double all = 0;
  for (std::size_t i = 0; i < std::min(count, heaviest.size()); ++i) all += heaviest[i].weight;
  for (std::size_t i = 0; i < count; ++i) {
    Lobe& lobe = lobes_[i];
    lobe.share = given_share;
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

/// The irradiance that each sample estimates, where it found light.
std::vector<AimedLobes::Found> AimedLobes::found(std::span<const TrainingSample> samples) {
  std::vector<Found> found;
  for (const TrainingSample& s : samples) {
    const float weight = s.pdf > 0 ? s.radiance * s.cosine / s.pdf : 0.0F;
    if (weight > 0 && std::isfinite(weight)) found.push_back({s.x, s.w, s.distance, weight});
  }
  return found;
}

void AimedLobes::learn(std::span<const TrainingSample> all) {
  const std::vector<Found> batch = found(all);
  if (batch.empty()) return;
  V3d places(0, 0, 0);
  for (const Found& l : batch) places += V3d(l.x);
  const bool first = !(evidence_.weight > 0);
  if (empty()) begin(V3f(places / double(batch.size())));
  places_ += places;
  placed_ += double(batch.size());

  const double most = most_weight(batch);
  std::vector<Seen> samples;
  samples.reserve(batch.size());
  for (const Found& l : batch) {
    samples.push_back(seen(l));
    // At most 1: sums of floats do not overflow.
    samples.back().weight = static_cast<float>(std::min(double(l.weight) / most, 1.0));
  }
  Evidence sum;
  for (int k = 0; k < (first ? first_fits : later_fits); ++k) {
    sum = evidence_;
    sum.add(expect(samples), most);
    maximise(sum);
  }
  evidence_ = sum;
}

/// The weight to which larger ones are reduced: a share most_of_all of all that are reduced so. The
/// least one, if the first samples are too few for that.
double AimedLobes::most_weight(std::span<const Found> batch) const {
  double least = HUGE_VAL, most = 0;
  for (const Found& l : batch) {
    least = std::min(least, double(l.weight));
    most = std::max(most, double(l.weight));
  }
  const double floor = evidence_.weight > 0 ? 0 : least;
  for (;;) {
    double all = evidence_.weight;
    for (const Found& l : batch) all += std::min(double(l.weight), most);
    const double lower = std::max(most_of_all * all, floor);
    if (lower > near_enough * most) return most;
    most = lower;
  }
}

void AimedLobes::begin(const V3f& pivot) {
  pivot_ = pivot;
  begun_ = true;
  constexpr double golden_angle = 2.39996322972865332;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * double(i) + 1) / double(count), r = std::sqrt(1 - z * z);
    const double phi = golden_angle * double(i);
    lobes_[i] = {.aim = {{r * std::cos(phi), r * std::sin(phi), z}, 0},
                 .concentration = first_concentration,
                 .share = 1.0 / double(count)};
  }
  pack();
}

AimedLobes::Seen AimedLobes::seen(const Found& light) const {
  Seen distant{light.w, light.w, 0, 0};
  if (!std::isfinite(light.distance)) return distant;
  const V3d to = V3d(light.x) - V3d(pivot_) + V3d(light.w) * double(light.distance);
  const double length = length_of(to), inverse = 1 / length;
  if (!(length > 0) || !std::isfinite(inverse)) return distant;
  return {V3f(to * inverse), light.w, static_cast<float>(inverse), 0};
}

void AimedLobes::Evidence::add(const Evidence& other, double scale) {
  weight += other.weight * scale;
  squares += other.squares * scale * scale;
  for (std::size_t i = 0; i < count; ++i) {
    lobes[i].weight += other.lobes[i].weight * scale;
    lobes[i].inverse_distance += other.lobes[i].inverse_distance * scale;
    lobes[i].from_pivot += other.lobes[i].from_pivot * scale;
    lobes[i].from_place += other.lobes[i].from_place * scale;
  }
}

AimedLobes::Evidence AimedLobes::expect(std::span<const Seen> batch) const {
  Evidence evidence;
  Float8 weight, inverse;
  Float8x3 from_pivot, from_place;
  const Mask8 aimed = mask_from_bits(packed_.aimed);
  const V3f pivot(0, 0, 0);
  const Float8 least = stray_density;
  for (const Seen& s : batch) {
    const Float8x3 there{s.from_pivot.x, s.from_pivot.y, s.from_pivot.z};
    const Float8x3 here{s.from_place.x, s.from_place.y, s.from_place.z};
    // Lobes that are not aimed look the same from everywhere.
    const Float8 part = max(packed_.densities(pivot, select(aimed, there, here)), least);
    const Float8 own = part * (s.weight / reduce_add(part));
    weight = weight + own;
    inverse = inverse + own * s.inverse_distance;
    from_pivot = from_pivot + there * own;
    from_place = from_place + here * own;
    evidence.weight += double(s.weight);
    evidence.squares += double(s.weight) * double(s.weight);
  }
  alignas(32) std::array<std::array<float, count>, 8> sums;
  const std::array<Float8, 8> all{weight,       inverse,      from_pivot.x, from_pivot.y,
                                  from_pivot.z, from_place.x, from_place.y, from_place.z};
  for (std::size_t k = 0; k < all.size(); ++k) all[k].store(sums[k].data());
  for (std::size_t i = 0; i < count; ++i) {
    evidence.lobes[i] = {double(sums[0][i]), double(sums[1][i]),
                         V3d(sums[2][i], sums[3][i], sums[4][i]),
                         V3d(sums[5][i], sums[6][i], sums[7][i])};
  }
  return evidence;
}

void AimedLobes::maximise(const Evidence& evidence) {
  // As many of equal weight would tell as much.
  const double samples = evidence.weight * (evidence.weight / evidence.squares);
  for (std::size_t i = 0; i < count; ++i) {
    const Evidence::OfLobe& of = evidence.lobes[i];
    Lobe& lobe = lobes_[i];
    const double own = samples * (of.weight / evidence.weight);
    lobe.share = (own + given_share) / (samples + double(count) * given_share);
    const double there = length_of(of.from_pivot), here = length_of(of.from_place);
    const double length = std::max(there, here);
    if (!(own > least_samples) || !(length > 0)) continue;
    // The longer mean vector is that of the narrower lobe.
    lobe.aimed = there >= here;
    if (lobe.aimed) {
      lobe.aim = {of.from_pivot / length, of.inverse_distance / of.weight};
    } else {
      lobe.aim = {of.from_place / length, 0};
    }
    // Of the mean vector's length (Banerjee et al. 2005, 4.4).
    const double r = std::min(length / of.weight, 1.0) * own / (own + given_directions);
    lobe.concentration =
        std::clamp(r * (3 - r * r) / (1 - r * r), least_concentrated, most_concentrated);
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
    packed_.fall[i] = static_cast<float>(-k / (2 * ln2));
    packed_.peak[i] = static_cast<float>(lobe.share * k / (2 * double(pi) * -std::expm1(-2 * k)));
  }
}

void AimedLobes::next_round() {
  if (placed_ > 0) move_pivot(V3f(places_ / placed_));
  places_ = V3d(0, 0, 0);
  placed_ = 0;
  Evidence half;
  half.add(evidence_, 0.5);
  half.squares = evidence_.squares / 2;  // half as many samples
  evidence_ = half;
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
    Evidence::OfLobe& of = evidence_.lobes[i];
    const double length = length_of(of.from_pivot);
    if (!(length > 0) || !(of.weight > 0)) continue;
    Aim mean{of.from_pivot / length, of.inverse_distance / of.weight};
    mean.move(by);
    of.from_pivot = mean.axis * length;
    of.inverse_distance = mean.inverse_distance * of.weight;
  }
  pack();
}

/// Calls `use` for each number of the state, in one order.
template <class Self, class Use>
void AimedLobes::for_each_number(Self& self, const Use& use) {
  const auto each = [&use](auto&... all) { (use(all), ...); };
  each(self.begun_, self.pivot_.x, self.pivot_.y, self.pivot_.z);
  each(self.places_.x, self.places_.y, self.places_.z, self.placed_);
  for (auto& l : self.lobes_) {
    each(l.aim.axis.x, l.aim.axis.y, l.aim.axis.z, l.aim.inverse_distance);
    each(l.concentration, l.share, l.aimed);
  }
  each(self.evidence_.weight, self.evidence_.squares);
  for (auto& l : self.evidence_.lobes) {
    each(l.weight, l.inverse_distance, l.from_pivot.x, l.from_pivot.y, l.from_pivot.z);
    each(l.from_place.x, l.from_place.y, l.from_place.z);
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
  if (!valid || !(evidence_.weight >= 0)) throw std::runtime_error("saved lobes are not valid");
  pack();
}

}  // namespace lacuna
