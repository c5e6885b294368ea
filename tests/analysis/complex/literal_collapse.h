#pragma once

#include <functional>
#include <vector>

#include "analysis/complex/cubical_complex.h"

namespace lacuna::testing {

/// Alg. 2 of the thesis word by word, on sets of faces: what the word-wide collapse is held
/// against.
class LiteralComplex {
 public:
  explicit LiteralComplex(const CubicalComplex& c) : size_(c.size() + Imath::V3i(3)) {
    faces_.resize(index(size_ - Imath::V3i(1), face_types - 1) + 1);
    each([&](Imath::V3i cell, FaceType m) {
      const Imath::V3i s = c.size();
      if (cell.x <= s.x && cell.y <= s.y && cell.z <= s.z) at(cell, m) = c.has(cell, m);
    });
  }

  bool has(Imath::V3i cell, FaceType m) const {
    if (cell.x < 0 || cell.y < 0 || cell.z < 0) return false;
    return const_cast<LiteralComplex*>(this)->at(cell, m);
  }

  /// One run of the loop of Alg. 2; `kept` says which faces W holds. False if nothing was removed.
  bool layer(const std::function<bool(Imath::V3i, FaceType)>& kept) {
    const std::vector<char> border = closed_border();
    bool any = false;
    for (int t = 0; t < 3; ++t) {
      for (int s = 0; s < 2; ++s) {
        for (int d = 3; d >= 1; --d) any = remove(t, s, d, border, kept) || any;
      }
    }
    return any;
  }

  /// Whether no other face strictly contains this one.
  bool is_facet(Imath::V3i cell, FaceType m) const { return containing(cell, m).empty(); }

 private:
  struct Face {
    Imath::V3i cell;
    FaceType type;
  };
  static Imath::V3i unit(int axis) { return {axis == 0, axis == 1, axis == 2}; }
  char& at(Imath::V3i c, FaceType m) { return faces_[index(c, m)]; }
  std::size_t index(Imath::V3i c, FaceType m) const {
    const int i = ((c.z * size_.y + c.y) * size_.x + c.x) * face_types + m;
    return static_cast<std::size_t>(i);
  }
  void each(const std::function<void(Imath::V3i, FaceType)>& visit) const {
    for (int z = 0; z < size_.z - 1; ++z) {
      for (int y = 0; y < size_.y - 1; ++y) {
        for (int x = 0; x < size_.x - 1; ++x) {
          for (FaceType m = 0; m < face_types; ++m) visit({x, y, z}, m);
        }
      }
    }
  }
  /// Every face of the complex that strictly contains this one.
  std::vector<Face> containing(Imath::V3i cell, FaceType m) const {
    std::vector<Face> found;
    for (FaceType more = 1; more < face_types; ++more) {
      if ((more & m) != 0) continue;
      for (int back = 0; back < face_types; ++back) {
        if ((back & ~more) != 0) continue;
        const Imath::V3i c = cell - Imath::V3i(back & 1, back >> 1 & 1, back >> 2 & 1);
        if (has(c, m | more)) found.push_back({c, m | more});
      }
    }
    return found;
  }
  void close(std::vector<char>& set, Imath::V3i cell, FaceType m) const {
    for (FaceType sub = 0; sub < face_types; ++sub) {
      if ((sub & ~m) != 0) continue;
      const int flat = m & ~sub;
      for (int up = 0; up < face_types; ++up) {
        if ((up & ~flat) != 0) continue;
        const Imath::V3i c = cell + Imath::V3i(up & 1, up >> 1 & 1, up >> 2 & 1);
        set[index(c, sub)] = 1;
      }
    }
  }
  std::vector<char> closed_border() const {
    std::vector<char> set(faces_.size());
    each([&](Imath::V3i cell, FaceType m) {
      if (!has(cell, m)) return;
      const auto above = containing(cell, m);
      if (above.size() == 1) close(set, above[0].cell, above[0].type);
    });
    return set;
  }
  bool remove(int t, int s, int d, const std::vector<char>& border,
              const std::function<bool(Imath::V3i, FaceType)>& kept) {
    std::vector<Face> gone;
    const auto in_border = [&](Imath::V3i c, FaceType m) { return border[index(c, m)]; };
    each([&](Imath::V3i cell, FaceType g) {
      if (!has(cell, g) || dimension(g) != d - 1 || (g & 1 << t) != 0 || kept(cell, g)) return;
      const auto above = containing(cell, g);
      const Imath::V3i f_cell = s == 0 ? cell : cell - unit(t);
      const FaceType f = g | 1 << t;
      if (above.size() != 1 || above[0].cell != f_cell || above[0].type != f) return;
      if (!in_border(f_cell, f) || !in_border(cell, g)) return;
      gone.push_back({cell, g});
      gone.push_back({f_cell, f});
    });
    for (const Face& f : gone) at(f.cell, f.type) = 0;
    return !gone.empty();
  }

  Imath::V3i size_;
  std::vector<char> faces_;
};

}  // namespace lacuna::testing
