#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lacuna {

/// Cells [x, x + 1] x [y, y + 1] x [z, z + 1] with low <= (x, y, z) < high.
struct CellBox {
  Imath::V3i low{0}, high{0};
  int side(int axis) const { return high[axis] - low[axis]; }
};

/// Finds the closed unit cells that intersect a closed triangle, by separating axes: the cell's
/// three, the triangle's normal, and the normals of its edges projected along the cell's axes
/// (Schwarz and Seidel 2010). A triangle may be degenerate: a segment or a point.
///
/// In double, not in integers on a lattice, so that triangles are not moved. Every comparison is
/// relaxed by `slack`, which by far exceeds the rounding error while coordinates stay within 4096
/// cells (about 1e-11: axes are scaled by the edges they come from, so a sliver's uncertain normal
/// has a small weight): a cell that intersects the triangle is never missed.
class TriangleBox {
 public:
  static constexpr double slack = 1e-9;

  /// The triangle's corners, in cells.
  explicit TriangleBox(const std::array<Imath::V3d, 3>& corners);

  /// The cells that intersect the triangle's bounding box.
  const CellBox& bounds() const { return bounds_; }

  /// Calls emit(axis, first, count) for lines of `count` cells along `axis` from cell `first` on:
  /// all cells of `clip` that intersect the triangle, each once.
  template <class Emit>
  void for_each_line(const CellBox& clip, Emit&& emit) const {
    CellBox box;
    for (int a = 0; a < 3; ++a) {
      box.low[a] = std::max(clip.low[a], bounds_.low[a]);
      box.high[a] = std::min(clip.high[a], bounds_.high[a]);
      if (box.low[a] >= box.high[a]) return;
    }
    int thick = 0;
    for (int a = 0; a < 3; ++a) thick += bounds_.side(a) > 1 ? 1 : 0;
    if (thick <= 1) {  // one line of cells: the triangle, which is connected, intersects each
      const int along = bounds_.side(0) > 1 ? 0 : bounds_.side(1) > 1 ? 1 : 2;
      emit(along, box.low, box.side(along));
    } else {
      Axes(corners_, bounds_).scan(box, emit);
    }
  }

 private:
  /// An axis in two of the dimensions, solved for one of them: a cell at (x, y) is not separated if
  /// (lower - y * other) * inverse <= x <= (upper - y * other) * inverse.
  struct Axis2 {
    double other, inverse, lower, upper;
  };
  /// Positions between two real bounds.
  struct Range {
    double low, high;
    void narrow(double inverse, double lower, double upper) {
      low = std::max(low, lower * inverse);
      high = std::min(high, upper * inverse);
    }
    int first() const { return ceiling(low - slack); }
    int last() const { return floored(high + slack); }
  };

  /// All axes but the cell's own. Lines of cells run along `w`, rows of lines along `u`.
  struct Axes {
    int u, v, w;
    std::array<Axis2, 3> uv, wu, wv;            // solved for the first
    double normal_u, normal_v, normal_inverse;  // of the triangle's normal, solved for w
    double lower, upper;

    Axes(const std::array<Imath::V3d, 3>& corners, const CellBox& bounds);

    template <class Emit>
    void scan(const CellBox& box, Emit&& emit) const {
      Imath::V3i first;
      for (first[v] = box.low[v]; first[v] < box.high[v]; ++first[v]) {
        const double at_v = first[v];
        Range row{static_cast<double>(box.low[u]), static_cast<double>(box.high[u] - 1)};
        Range plane{static_cast<double>(box.low[w]), static_cast<double>(box.high[w] - 1)};
        for (const Axis2& a : uv)
          row.narrow(a.inverse, a.lower - a.other * at_v, a.upper - a.other * at_v);
        for (const Axis2& a : wv)
          plane.narrow(a.inverse, a.lower - a.other * at_v, a.upper - a.other * at_v);
        const int end = row.last();
        for (first[u] = row.first(); first[u] <= end; ++first[u]) {
          const double at_u = first[u], offset = normal_u * at_u + normal_v * at_v;
          Range line = plane;
          line.narrow(normal_inverse, lower - offset, upper - offset);
          for (const Axis2& a : wu)
            line.narrow(a.inverse, a.lower - a.other * at_u, a.upper - a.other * at_u);
          first[w] = line.first();
          const int count = line.last() - first[w] + 1;
          if (count > 0) emit(w, first, count);
        }
      }
    }
  };

  static int ceiling(double x) { return static_cast<int>(std::ceil(std::clamp(x, -1e9, 1e9))); }
  static int floored(double x) { return static_cast<int>(std::floor(std::clamp(x, -1e9, 1e9))); }

  std::array<Imath::V3d, 3> corners_;
  CellBox bounds_;
};

}  // namespace lacuna
