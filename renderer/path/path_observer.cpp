#include "renderer/path/path_observer.h"

#include <algorithm>
#include <tuple>

#include "renderer/path/path_letters.h"

namespace lacuna {
namespace {

bool is_infinite(const Vertex& v) { return v.kind == Vertex::Kind::background; }

/// The unit direction from `a` to `b`.
V3f towards(const Vertex& a, const Vertex& b) {
  return is_infinite(b) ? b.surface.x : (b.surface.x - a.surface.x).normalized();
}

TracedVertex traced(const Vertex& v, bool from_light, bool is_eye) {
  return {v.surface.x, is_infinite(v), from_light, is_eye ? 0.0 : double(v.p_fwd.value)};
}

}  // namespace

std::uint32_t PathObserver::add(TracedPath path, std::span<const Vertex* const> from_eye,
                                std::span<const Vertex* const> from_light) {
  std::vector<const Vertex*> all(from_eye.begin(), from_eye.end());
  all.insert(all.end(), from_light.rbegin(), from_light.rend());
  path.letters.assign(1, 'E');
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool by_light = i >= from_eye.size();
    path.vertices.push_back(traced(*all[i], by_light, i == 0));
    if (i == 0 || i + 1 == all.size()) continue;
    const bool at_connection =
        !from_light.empty() && (i + 1 == from_eye.size() || i == from_eye.size());
    const Vertex& v = *all[i];
    const PathSymbol letter =
        letter_at(v, towards(v, *all[i - 1]), towards(v, *all[i + 1]), !at_connection && v.delta);
    path.letters += "DGS"[static_cast<std::size_t>(letter) / 2];
  }
  path.letters += 'L';
  const std::lock_guard lock(mutex_);
  kept_.push_back({std::move(path)});
  return static_cast<std::uint32_t>(kept_.size());
}

void PathObserver::arrived(std::uint32_t number) {
  const std::lock_guard lock(mutex_);
  kept_[number - 1].arrived = true;
}

void PathObserver::arrived(std::uint32_t number, const Rgb& value) {
  const std::lock_guard lock(mutex_);
  kept_[number - 1].path.value = value;
  kept_[number - 1].arrived = true;
}

std::vector<TracedPath> PathObserver::take() {
  std::vector<TracedPath> paths;
  for (Kept& k : kept_) {
    if (k.arrived) paths.push_back(std::move(k.path));
  }
  kept_.clear();
  std::ranges::sort(paths, [](const TracedPath& a, const TracedPath& b) {
    const auto key = [](const TracedPath& p) {
      return std::tuple(-luminance(p.value), p.s, p.t, p.value.x, p.value.y, p.weight);
    };
    return key(a) < key(b);
  });
  return paths;
}

}  // namespace lacuna
