#include "renderer/guides/direction_tree.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/core/sampling.h"

namespace lacuna {

namespace {

constexpr float below_one = 1 - 0x1p-24F;

V2f corner_of(std::size_t quarter) {
  return {quarter % 2 == 1 ? 0.5F : 0.0F, quarter / 2 == 1 ? 0.5F : 0.0F};
}

/// Selects one of two halves with these weights by uniform `u`, which becomes its remainder,
/// uniform again. Returns 1 for the second.
std::size_t upper_half(double& u, double first, double second) {
  const double share = first / (first + second);
  const bool upper = u >= share;
  u = std::min(upper ? (u - share) / (1 - share) : u / share, 1 - 0x1p-53);
  return upper ? 1 : 0;
}

}  // namespace

V2f to_square(const V3f& w) {
  const float phi = std::atan2(w.y, w.x) / (2 * pi);
  return {std::clamp((w.z + 1) / 2, 0.0F, below_one),
          std::clamp(phi < 0 ? phi + 1 : phi, 0.0F, below_one)};
}

V3f from_square(const V2f& p) {
  const float z = 2 * p.x - 1, r = std::sqrt(std::max(0.0F, 1 - z * z)), phi = 2 * pi * p.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

std::size_t DirectionTree::quarter(V2f& p) {
  const bool x = p.x >= 0.5F, y = p.y >= 0.5F;
  p.x = std::min(below_one, 2 * p.x - (x ? 1.0F : 0.0F));
  p.y = std::min(below_one, 2 * p.y - (y ? 1.0F : 0.0F));
  return (x ? 1U : 0U) + (y ? 2U : 0U);
}

double DirectionTree::leaf_size(V2f p) const {
  double size = 0.5;
  std::uint32_t node = 0;
  for (;;) {
    node = nodes_[node].child[quarter(p)];
    if (node == 0) return size;
    size /= 2;
  }
}

void DirectionTree::add(const V3f& w, double energy, bool filter) {
  V2f p = to_square(w);
  if (filter) {
    const auto half = static_cast<float>(leaf_size(p) / 2);
    const Rectangle area{p - V2f(half), p + V2f(half)};
    const double density = energy / (4 * double(half) * double(half));
    // The azimuth wraps around; energy beyond the poles is lost.
    for (const float shift : {-1.0F, 0.0F, 1.0F}) {
      spread(0, V2f(0, shift), 1, area, density);
    }
    return;
  }
  std::uint32_t node = 0;
  for (;;) {
    const std::size_t q = quarter(p);
    if (nodes_[node].child[q] == 0) {
      nodes_[node].energy[q] += static_cast<float>(energy);
      return;
    }
    node = nodes_[node].child[q];
  }
}

/// Adds `density` over the intersection of `area` with the square at `low`.
void DirectionTree::spread(std::uint32_t node, const V2f& low, float size, const Rectangle& area,
                           double density) {
  for (std::size_t q = 0; q < 4; ++q) {
    const V2f at = low + corner_of(q) * size;
    const float half = size / 2;
    const float width = std::min(at.x + half, area.high.x) - std::max(at.x, area.low.x);
    const float height = std::min(at.y + half, area.high.y) - std::max(at.y, area.low.y);
    if (!(width > 0 && height > 0)) continue;
    if (nodes_[node].child[q] != 0) {
      spread(nodes_[node].child[q], at, half, area, density);
    } else {
      nodes_[node].energy[q] += static_cast<float>(density * double(width) * double(height));
    }
  }
}

void DirectionTree::build() { build(0); }

double DirectionTree::build(std::uint32_t node) {
  for (std::size_t q = 0; q < 4; ++q) {
    const std::uint32_t child = nodes_[node].child[q];
    if (child != 0) nodes_[node].energy[q] = static_cast<float>(build(child));
  }
  return sum(nodes_[node]);
}

V3f DirectionTree::sample(const Rng::FinePoint& u) const {
  double x = static_cast<double>(u.x) * 0x1p-64, y = double(u.y) * 0x1p-32;
  V2f low(0, 0);
  float size = 1;
  std::uint32_t node = 0;
  for (;;) {
    const std::array<float, 4>& e = nodes_[node].energy;
    const std::size_t column =
        upper_half(x, double(e[0]) + double(e[2]), double(e[1]) + double(e[3]));
    const std::size_t row = upper_half(y, double(e[column]), double(e[column + 2]));
    const std::size_t q = column + 2 * row;
    low += corner_of(q) * size;
    size /= 2;
    if (nodes_[node].child[q] == 0) break;
    node = nodes_[node].child[q];
  }
  const V2f p = low + V2f(static_cast<float>(x), static_cast<float>(y)) * size;
  return from_square({std::min(p.x, below_one), std::min(p.y, below_one)});
}

Pdf<SolidAngle> DirectionTree::pdf(const V3f& w) const {
  V2f p = to_square(w);
  double density = 1 / (4 * double(pi));
  std::uint32_t node = 0;
  for (;;) {
    const Node& n = nodes_[node];
    const std::size_t q = quarter(p);
    if (!(n.energy[q] > 0)) return {};
    density *= 4 * double(n.energy[q]) / sum(n);
    if (n.child[q] == 0) return Pdf<SolidAngle>(static_cast<float>(density));
    node = n.child[q];
  }
}

DirectionTree DirectionTree::refined(double share, int depth) const {
  struct Task {
    std::uint32_t to, from;  // indices in both trees; from: 0, except for the root, in a leaf,
                             // whose quadrants have equal energy
    std::size_t quarter;     // of the leaf that is being split; 4: `from` is a node
    double energy;           // of the node
    int level;
  };
  DirectionTree result;
  const double all = energy();
  std::vector<Task> tasks{{0, 0, 4, all, 1}};
  while (!tasks.empty()) {
    const Task t = tasks.back();
    tasks.pop_back();
    for (std::size_t q = 0; q < 4; ++q) {
      const bool own = t.quarter == 4;  // the node exists in this tree
      const double part = own ? double(nodes_[t.from].energy[q]) : t.energy / 4;
      if (t.level >= depth || !(part > share * all)) continue;
      const auto child = static_cast<std::uint32_t>(result.nodes_.size());
      result.nodes_.emplace_back();
      result.nodes_[t.to].child[q] = child;
      const std::uint32_t from = own ? nodes_[t.from].child[q] : 0;
      tasks.push_back({child, from, from != 0 ? std::size_t{4} : q, part, t.level + 1});
    }
  }
  return result;
}

void DirectionTree::load(ByteReader& in) {
  nodes_ = in.get_vector<Node>();
  bool good = !nodes_.empty();
  for (std::size_t i = 0; i < nodes_.size() && good; ++i) {
    for (std::size_t q = 0; q < 4; ++q) {
      const std::uint32_t child = nodes_[i].child[q];
      // Children follow their parents, so there are no cycles.
      good = good && (child == 0 || (child > i && child < nodes_.size()));
      good = good && nodes_[i].energy[q] >= 0 && std::isfinite(nodes_[i].energy[q]);
    }
  }
  if (!good) throw std::runtime_error("saved directions are not a valid tree");
}

}  // namespace lacuna
