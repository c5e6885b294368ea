#include "analysis/complex/complex_components.h"

namespace lacuna {
namespace {

/// Copies one row of a plane: bit i of `row` is the face of that type at cell (i - 1, y, z).
void gather(const CubicalComplex& c, FaceType type, int y, int z, std::vector<std::uint64_t>& row) {
  const std::size_t block = c.index(0, (y >> 3) + 1, (z >> 3) + 1);
  const auto width = static_cast<std::size_t>(c.blocks().x);
  std::fill(row.begin(), row.end(), 0);
  for (std::size_t b = 0; b < width; ++b) {
    const BitBlock bits = c.data()[block + b].faces[static_cast<std::size_t>(type)].bits();
    const std::uint64_t byte = bits.z[static_cast<std::size_t>(z & 7)] >> (y & 7) * 8 & 0xff;
    if (byte == 0) continue;
    // Cell -1 is the last of block 0, so block b begins at bit 8 b - 7.
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(8 * b) - 7;
    if (at < 0) {
      row[0] |= byte >> -at;
      continue;
    }
    const auto word = static_cast<std::size_t>(at) / 64, shift = static_cast<std::size_t>(at) % 64;
    if (word < row.size()) row[word] |= byte << shift;
    if (shift > 56 && word + 1 < row.size()) row[word + 1] |= byte >> (64 - shift);
  }
}

void complement(std::vector<std::uint64_t>& row, int width) {
  for (std::uint64_t& w : row) w = ~w;
  if (width % 64 != 0) row.back() &= (std::uint64_t{1} << width % 64) - 1;
}

}  // namespace

ComplementComponents::ComplementComponents(const CubicalComplex& complex)
    : runs_(complex.size() + Imath::V3i(2), [&complex](int y, int z, CellRow& row) {
        gather(complex, 7, y - 1, z - 1, row.present);
        gather(complex, 6, y - 1, z - 1, row.link_x);
        gather(complex, 5, y - 1, z - 1, row.link_y);
        gather(complex, 3, y - 1, z - 1, row.link_z);
        const int width = complex.size().x + 2;
        for (auto* bits : {&row.present, &row.link_x, &row.link_y, &row.link_z}) {
          complement(*bits, width);
        }
      }) {}

std::uint32_t component_count(const CubicalComplex& complex) {
  // Every component has a vertex, and edges join all of its vertices. The edge along x at a cell
  // leads to the next vertex: it is fetched from one cell before.
  return RunComponents(complex.size() + Imath::V3i(2),
                       [&complex](int y, int z, CellRow& row) {
                         gather(complex, 0, y - 1, z - 1, row.present);
                         gather(complex, 1, y - 1, z - 1, row.link_x);
                         std::uint64_t carry = 0;
                         for (std::uint64_t& w : row.link_x) {
                           const std::uint64_t out = w >> 63;
                           w = w << 1 | carry;
                           carry = out;
                         }
                         gather(complex, 2, y - 2, z - 1, row.link_y);
                         gather(complex, 4, y - 1, z - 2, row.link_z);
                       })
      .count();
}

}  // namespace lacuna
