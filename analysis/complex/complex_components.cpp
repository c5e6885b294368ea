#include "analysis/complex/complex_components.h"

#include "analysis/space/bit_rows.h"

namespace lacuna {
namespace {

/// Copies one row of a plane: bit i of `row` is the face of that type at cell (i - 1, y, z).
void gather(const CubicalComplex& c, FaceType type, int y, int z, BitRow& row) {
  const std::size_t block = c.index(0, (y >> 3) + 1, (z >> 3) + 1);
  row.clear();
  for (int b = 0; b < c.blocks().x; ++b) {
    const auto& faces = c.data()[block + static_cast<std::size_t>(b)].faces;
    const BitBlock bits = faces[static_cast<std::size_t>(type)].bits();
    const std::uint64_t byte = bits.z[static_cast<std::size_t>(z & 7)] >> (y & 7) * 8 & 0xff;
    if (byte != 0) row.add_byte(byte, 8 * b - 7);  // cell -1 is the last of block 0
  }
}

/// Rows of a grid with one more cell on every side than the complex: which cells exist, and which
/// are linked to the preceding cell along an axis. `Cells` has present(y, z, row) and links(axis,
/// y, z, row), with y and z in the complex.
template <class Cells>
struct ComplexRows {
  Cells cells;
  BitRow present, link_x, link;

  explicit ComplexRows(const CubicalComplex& c)
      : cells{c}, present(c.size().x + 2), link_x(present), link(present) {}

  template <class Visit>
  void for_each_run(int y, int z, const Visit& visit) {
    cells.present(y - 1, z - 1, present);
    cells.links(0, y - 1, z - 1, link_x);
    present.for_each_run([&](int x0, int end) {
      while (x0 < end) {  // a run ends before a cell that is not linked to the one before it
        const int x1 = std::min(end, link_x.next(x0 + 1, false));
        visit(x0, x1);
        x0 = x1;
      }
    });
  }
  void read_links(int y, int z, int axis) { cells.links(axis, y - 1, z - 1, link); }
  bool linked(const ComponentRun& here, const ComponentRun& before) const {
    return link.next(std::max(here.x0, before.x0), true) < std::min(here.x1, before.x1);
  }
};

struct MissingCubes {
  const CubicalComplex& complex;

  void present(int y, int z, BitRow& row) const {
    gather(complex, 7, y, z, row);
    row.complement();
  }
  void links(int axis, int y, int z, BitRow& row) const {
    gather(complex, 7 - (1 << axis), y, z, row);  // the square across the axis
    row.complement();
  }
};

/// Every component has a vertex, and edges join all of its vertices. The edge along an axis at a
/// cell leads to the next vertex.
struct Vertices {
  const CubicalComplex& complex;

  void present(int y, int z, BitRow& row) const { gather(complex, 0, y, z, row); }
  void links(int axis, int y, int z, BitRow& row) const {
    gather(complex, 1 << axis, y - (axis == 1 ? 1 : 0), z - (axis == 2 ? 1 : 0), row);
    if (axis == 0) row.shift_up();
  }
};

template <class Cells>
RunComponents components_of(const CubicalComplex& complex, const ThreadPool& pool) {
  return label_runs(complex.size() + Imath::V3i(2), ComplexRows<Cells>(complex),
                    Connectivity::faces, pool);
}

}  // namespace

ComplementComponents::ComplementComponents(const CubicalComplex& complex, const ThreadPool& pool)
    : components_(components_of<MissingCubes>(complex, pool)) {}

std::uint32_t component_count(const CubicalComplex& complex) {
  return static_cast<std::uint32_t>(components_of<Vertices>(complex, ThreadPool(1)).count());
}

}  // namespace lacuna
