#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "analysis/artefacts/packing.h"
#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "analysis/skeleton/graph.h"

namespace lacuna {

/// The serialisation of an artefact: specialise with
///
///     static void write(ArtefactWriter& out, const T& value);
///     static T read(ArtefactReader& in);
///
/// read() validates its input: it throws std::runtime_error for data that write() cannot have
/// written, and allocates no more than the remaining bytes can fill.
template <class T>
struct Codec;

/// For read(): throws std::runtime_error(what) unless `holds`.
inline void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

/// True if every byte pattern is a value of T and T has no padding: specialise it for such structs.
template <class T>
inline constexpr bool is_plain =
    std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, long double>;
template <class T>
inline constexpr bool is_plain<Imath::Vec2<T>> = is_plain<T>;
template <class T>
inline constexpr bool is_plain<Imath::Vec3<T>> = is_plain<T>;
template <class T, std::size_t n>
inline constexpr bool is_plain<std::array<T, n>> = is_plain<T>;

/// Writes all values in order.
template <class... T>
void encode(ArtefactWriter& out, const T&... values) {
  (Codec<T>::write(out, values), ...);
}
template <class T>
T decode(ArtefactReader& in) {
  return Codec<T>::read(in);
}

template <class T>
requires is_plain<T>
struct Codec<T> {
  static void write(ArtefactWriter& out, const T& value) { out.append(&value, sizeof(T)); }
  static T read(ArtefactReader& in) {
    T value;
    in.read(&value, sizeof(T));
    return value;
  }
};

template <class T>
requires is_plain<T>
struct Codec<std::vector<T>> {
  static void write(ArtefactWriter& out, const std::vector<T>& values) {
    out.put(static_cast<std::uint64_t>(values.size()));
    out.append(values.data(), sizeof(T) * values.size());
  }
  static std::vector<T> read(ArtefactReader& in) {
    std::vector<T> values(in.get_length(sizeof(T)));
    in.read(values.data(), sizeof(T) * values.size());
    return values;
  }
};

template <>
struct Codec<std::string> {
  static void write(ArtefactWriter& out, const std::string& text) {
    out.put(std::string_view(text));
  }
  static std::string read(ArtefactReader& in) { return in.get_string(); }
};

/// Reads the size of a grid, each side in [0, 65536]. Throws std::runtime_error if the remaining
/// input is shorter than `bytes` for each of its blocks of `side` x `side` x `side` voxels.
Imath::V3i read_grid_size(ArtefactReader& in, int side, std::size_t bytes);

template <class T>
requires is_plain<T>
struct Codec<Grid3<T>> {
  static void write(ArtefactWriter& out, const Grid3<T>& grid) {
    Codec<Imath::V3i>::write(out, grid.size());
    out.append(grid.data(), sizeof(T) * grid.count());
  }
  static Grid3<T> read(ArtefactReader& in) {
    Grid3<T> grid(read_grid_size(in, 1, sizeof(T)));
    in.read(grid.data(), sizeof(T) * grid.count());
    return grid;
  }
};

template <>
struct Codec<BitGrid3> {
  static void write(ArtefactWriter& out, const BitGrid3& grid);
  static BitGrid3 read(ArtefactReader& in);
};

template <>
struct Codec<GridTransform> {
  static void write(ArtefactWriter& out, const GridTransform& transform);
  static GridTransform read(ArtefactReader& in);
};

template <>
struct Codec<SkeletonGraph> {
  static void write(ArtefactWriter& out, const SkeletonGraph& graph);
  static SkeletonGraph read(ArtefactReader& in);
};

}  // namespace lacuna
