#include "analysis/complex/border.h"

namespace lacuna {
namespace {

constexpr FaceType X = 1, Y = 2, Z = 4;

/// Counts bits per cell: `one` contains the cells with at least one, `more` those with several.
struct ContactCount {
  Plane one, more;

  void add(Plane p) {
    more |= one & p;
    one |= p;
  }
  Plane exactly_one() const { return one & ~more; }
};

/// The edges along `a`: the squares around them lie at the cell and before it along b and c.
template <int a>
Plane free_edges(const ComplexBlock* x, const std::array<std::ptrdiff_t, 3>& stride,
                 Plane& facets) {
  constexpr int b = (a + 1) % 3, c = (a + 2) % 3;
  constexpr FaceType A = 1 << a, AB = A | 1 << b, AC = A | 1 << c;
  const Plane ab = x->faces[AB], ac = x->faces[AC];
  ContactCount n{ab, Plane::zero()};
  n.add(from_low<b>(ab, x[-stride[b]].faces[AB]));
  n.add(ac);
  n.add(from_low<c>(ac, x[-stride[c]].faces[AC]));
  facets = x->faces[A] & ~n.one;
  return n.exactly_one();
}

template <int a>
void add_edges_at_vertex(ContactCount& n, const ComplexBlock* x, std::ptrdiff_t stride) {
  const Plane e = x->faces[1 << a];
  n.add(e);
  n.add(from_low<a>(e, x[-stride].faces[1 << a]));
}

std::array<std::ptrdiff_t, 3> strides(const CubicalComplex& complex) {
  return {complex.stride(0), complex.stride(1), complex.stride(2)};
}

/// Squares that extend along a and b and contain a free edge.
template <int a, int b>
Plane squares_with_free_edge(const BorderBlock* l, const std::array<std::ptrdiff_t, 3>& stride) {
  const Plane fa = l->free_edges[a], fb = l->free_edges[b];
  return fa | from_high<b>(fa, l[stride[b]].free_edges[a]) | fb |
         from_high<a>(fb, l[stride[a]].free_edges[b]);
}

template <int a>
Plane edges_with_free_vertex(const BorderBlock* l, std::ptrdiff_t stride) {
  return l->free_vertices | from_high<a>(l->free_vertices, l[stride].free_vertices);
}

}  // namespace

std::array<Plane, 3> find_free(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                               std::size_t block) {
  const ComplexBlock* x = complex.data() + block;
  BorderBlock& l = border[block];
  const auto stride = strides(complex);
  std::array<Plane, 3> facets;
  l.free_edges = {free_edges<0>(x, stride, facets[0]), free_edges<1>(x, stride, facets[1]),
                  free_edges<2>(x, stride, facets[2])};
  ContactCount n{Plane::zero(), Plane::zero()};
  add_edges_at_vertex<0>(n, x, stride[0]);
  add_edges_at_vertex<1>(n, x, stride[1]);
  add_edges_at_vertex<2>(n, x, stride[2]);
  l.free_vertices = n.exactly_one();
  return facets;
}

Plane take_border_of(const CubicalComplex& complex, std::vector<BorderBlock>& border,
                     std::size_t block) {
  const ComplexBlock* x = complex.data() + block;
  const auto& f = x->faces;
  BorderBlock* l = border.data() + block;
  const auto stride = strides(complex);
  const auto [sx, sy, sz] = stride;
  // A cube has a free square where one of its six neighbours is missing.
  const Plane c = f[7];
  const Plane cubes = c & ~(from_low<0>(c, x[-sx].faces[7]) & from_high<0>(c, x[sx].faces[7]) &
                            from_low<1>(c, x[-sy].faces[7]) & from_high<1>(c, x[sy].faces[7]) &
                            from_low<2>(c, x[-sz].faces[7]) & from_high<2>(c, x[sz].faces[7]));
  l->layer(7) = cubes;
  const Plane yz = f[Y | Z] & (squares_with_free_edge<1, 2>(l, stride) | cubes |
                               from_low<0>(cubes, l[-sx].layer(7)));
  const Plane xz = f[X | Z] & (squares_with_free_edge<0, 2>(l, stride) | cubes |
                               from_low<1>(cubes, l[-sy].layer(7)));
  const Plane xy = f[X | Y] & (squares_with_free_edge<0, 1>(l, stride) | cubes |
                               from_low<2>(cubes, l[-sz].layer(7)));
  l->layer(Y | Z) = yz;
  l->layer(X | Z) = xz;
  l->layer(X | Y) = xy;
  l->layer(X) =
      f[X] & (edges_with_free_vertex<0>(l, sx) | xy | from_low<1>(xy, l[-sy].layer(X | Y)) | xz |
              from_low<2>(xz, l[-sz].layer(X | Z)));
  l->layer(Y) =
      f[Y] & (edges_with_free_vertex<1>(l, sy) | xy | from_low<0>(xy, l[-sx].layer(X | Y)) | yz |
              from_low<2>(yz, l[-sz].layer(Y | Z)));
  l->layer(Z) =
      f[Z] & (edges_with_free_vertex<2>(l, sz) | xz | from_low<0>(xz, l[-sx].layer(X | Z)) | yz |
              from_low<1>(yz, l[-sy].layer(Y | Z)));
  return cubes | xy | xz | yz | l->layer(X) | l->layer(Y) | l->layer(Z);
}

Reach reach_of(const Plane& cells) {
  const BitBlock b = cells.bits();
  std::uint64_t all = 0;
  for (const std::uint64_t w : b.z) all |= w;
  Reach r{Imath::V3i(0), Imath::V3i(0)};
  if (all & 0x0303030303030303u) r.low.x = -1;
  if (all & 0xc0c0c0c0c0c0c0c0u) r.high.x = 1;
  if (all & 0xffffu) r.low.y = -1;
  if (all & 0xffff000000000000u) r.high.y = 1;
  if ((b.z[0] | b.z[1]) != 0) r.low.z = -1;
  if ((b.z[6] | b.z[7]) != 0) r.high.z = 1;
  return r;
}

}  // namespace lacuna
