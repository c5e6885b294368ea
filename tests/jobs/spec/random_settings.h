#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <variant>

#include "jobs/spec/described.h"
#include "jobs/spec/job_spec.h"
#include "jobs/spec/limits.h"

namespace lacuna {

/// A visitor that fills every member with something that its table allows: a new setting is tested
/// as soon as it is in a table.
class RandomSettings {
 public:
  explicit RandomSettings(std::uint64_t seed) : random_(seed) {}

  template <class T>
  void operator()(std::string_view, T& member, const Field& field) {
    fill(member, field);
  }

  std::size_t below(std::size_t n) { return random_() % n; }

  template <class T>
  void fill(T& out, const Field& field) {
    if constexpr (std::is_same_v<T, bool>) {
      out = below(2) == 0;
    } else if constexpr (std::is_arithmetic_v<T>) {
      out = static_cast<T>(number(limits_of<T>(field), std::is_integral_v<T>));
    } else if constexpr (std::is_same_v<T, std::string>) {
      out = text(field);
    } else if constexpr (NamedEnum<T>) {
      out = EnumTable<T>::values[below(EnumTable<T>::values.size())].value;
    } else if constexpr (std::is_same_v<T, AutoNumber>) {
      out.value.reset();
      if (below(2) == 0) fill(out.value.emplace(), field);
    } else if constexpr (is_name_or<T>) {
      out = {};
      if (below(2) == 0) {
        fill(out.name, field);
      } else {
        describe(*this, out.object.emplace());
      }
    } else if constexpr (is_word_or<T>) {
      out = {};
      if (below(2) == 0) {
        fill(out.word, field);
      } else {
        describe(*this, out.object.emplace());
      }
    } else if constexpr (is_optional<T>) {
      out.reset();
      if (below(2) == 0) fill(out.emplace(), field);
    } else if constexpr (is_array<T>) {
      for (auto& element : out) fill(element, field);
    } else if constexpr (is_vector<T>) {
      const double least = std::max(field.min, 0.0), most = std::min(field.max, least + 5);
      out.resize(static_cast<std::size_t>(least) +
                 below(static_cast<std::size_t>(most - least) + 1));
      for (auto& element : out) fill(element, Field{});
    } else if constexpr (is_variant<T>) {
      alternative(out, below(std::variant_size_v<T>));
    } else {
      describe(*this, out);
    }
  }

 private:
  double number(const Limits& limits, bool integral) {
    const double low = std::max(limits.min, -1e18), high = std::min(limits.max, 1e18);
    switch (below(4)) {
      case 0:
        return limits.above_min ? high : low;
      case 1:
        return high;
      default: {
        const double share = std::ldexp(static_cast<double>(random_() >> 11) + 1, -53);
        const double scaled = below(2) == 0 ? share : std::pow(share, 8);
        const double value = low + (high - low) * scaled;
        return integral ? std::clamp(std::floor(value), low, high) : value;
      }
    }
  }

  std::string text(const Field& field) {
    static constexpr std::string_view pieces[] = {"a", "Z",  "0", " ",  "\"",     "\\",
                                                  "/", "\n", "ä", "世", "\u0001", "🙂"};
    const double longest = std::min(field.max, 40.0);
    std::string out;
    const auto n = static_cast<std::size_t>(std::max(field.min, 0.0)) +
                   below(static_cast<std::size_t>(longest - std::max(field.min, 0.0)) + 1);
    for (std::size_t i = 0; i < n; ++i) out += pieces[below(std::size(pieces))];
    return out;
  }

  template <std::size_t I = 0, class... Ts>
  void alternative(std::variant<Ts...>& out, std::size_t chosen) {
    if constexpr (I < sizeof...(Ts)) {
      if (I != chosen) return alternative<I + 1>(out, chosen);
      describe(*this, out.template emplace<I>());
    }
  }

  std::mt19937_64 random_;
};

/// Makes settings go together.
template <class Settings>
void reconcile(Settings& settings) {
  if (auto* path = std::get_if<PathSettings>(&settings); path && !path->conflict().empty()) {
    path->reuse = 1;
  }
  if (auto* vcm = std::get_if<VcmSettings>(&settings); vcm && !vcm->conflict().empty()) {
    vcm->connect = true;
    vcm->merge = false;
  }
}

/// A job that parse_job accepts: the rules beyond single fields hold too.
inline JobSpec random_job(std::uint64_t seed) {
  RandomSettings random(seed);
  JobSpec spec;
  describe(random, spec);
  if (auto& crop = spec.crop) {  // around what is rendered
    for (std::size_t k = 0; k < 2; ++k) {
      crop->of[k] = std::max(crop->of[k], crop->from[k] + spec.resolution[k]);
      crop->of[k] = std::min(crop->of[k], 65536);
      crop->from[k] = std::min(crop->from[k], crop->of[k] - spec.resolution[k]);
    }
  }
  spec.shard = std::min(spec.shard, spec.shards);
  if (auto& camera = spec.camera.object) {
    if (!frame_of(*camera)) camera = CameraSettings{};
    const CameraSettings none;
    if (camera->type != Projection::perspective) camera->aperture = 0, camera->fov = none.fov;
    if (camera->type != Projection::orthographic) camera->height = none.height;
    if (!(camera->aperture > 0)) camera->focus = 0, camera->blades = 0;
    if (camera->blades < 3) camera->blades = 0;
    if (camera->type == Projection::panorama) spec.pixel_filter = PixelFilter::box;
  }
  if (auto* foreign = std::get_if<ForeignSettings>(&spec.integrator)) {
    foreign->command.clear();
    if (foreign->pictures.empty()) foreign->command = {"render", "{out}"};
    spec.layers.clear();
    spec.shards = 1;
    spec.shard = 0;
  }
  if (auto* choosing = std::get_if<AutoSettings>(&spec.integrator)) {
    spec.shards = 1;
    spec.shard = 0;
    std::erase_if(choosing->candidates,
                  [&](CandidateSettings& c) { return !is_allowed(c, choosing->allow); });
    if (choosing->allow != Allow::unbiased) choosing->candidates.emplace_back(BdptSettings{});
    for (CandidateSettings& c : choosing->candidates) {
      std::visit([&](auto& s) { static_cast<PathLengths&>(s) = *choosing; }, c);
      reconcile(c);
    }
  }
  reconcile(spec.integrator);
  const std::vector<ImageLayer> offered = offered_layers(spec.integrator);
  std::vector<LayerRequest> layers;
  for (LayerRequest layer : spec.layers) {
    if (layer.object) {
      if (!without_letters(spec.integrator).empty()) continue;
      layer.object = {layers.size() % 2 == 0 ? "E.*L" : "!LS+DE", std::to_string(layers.size())};
    } else if (std::ranges::find(offered, layer.word) == offered.end() ||
               std::ranges::find(layers, layer) != layers.end()) {
      continue;
    }
    layers.push_back(std::move(layer));
  }
  spec.layers = std::move(layers);
  Budget& b = spec.budget;
  if (!b.seconds && !b.cpu_seconds && !b.iterations && !b.error) b.iterations = 1;
  if (spec.reference.empty()) spec.reference = "auto";
  return spec;
}

}  // namespace lacuna
