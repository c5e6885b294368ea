#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "analysis/artefacts/codec.h"
#include "analysis/octree/octree.h"
#include "analysis/space_analysis/space_codecs.h"
#include "tests/analysis/artefacts/entries.h"

namespace lacuna {
namespace {

/// Goes through a file and comes back.
template <class T>
class Trip {
 public:
  explicit Trip(const T& written)
      : Trip([&](ArtefactWriter& out) { encode(out, written); }, true) {}
  /// Content of any bytes.
  static Trip of_bytes(const std::string& bytes) {
    return Trip([&](ArtefactWriter& out) { out.append(bytes.data(), bytes.size()); }, true);
  }

  std::optional<T> value;
  std::optional<EntryRefusal> refusal;

 private:
  Trip(const std::function<void(ArtefactWriter&)>& write, bool) {
    const TemporaryFolder tmp;
    const ArtefactKey key = key_of("");
    const auto file = put_entry(tmp.path(), key, pack_entry(key, "", write));
    EntryHeader header;
    refusal = read_entry(file, key, header, [&](ArtefactReader& in) { value = decode<T>(in); });
  }
};

/// What a value's bytes are, before they are packed.
template <class... T>
std::string bytes_of(const T&... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

template <class T>
bool same(const Grid3<T>& a, const Grid3<T>& b) {
  return a.size() == b.size() && std::equal(a.data(), a.data() + a.count(), b.data());
}

Grid3<float> some_grid(Imath::V3i size) {
  Grid3<float> grid(size);
  for (std::size_t i = 0; i < grid.count(); ++i) grid[i] = static_cast<float>(i) / 7;
  return grid;
}

BitGrid3 some_bits(Imath::V3i size) {
  BitGrid3 bits(size);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if ((x * 7 + y * 3 + z) % 5 != 0) bits.set(x, y, z);
      }
    }
  }
  return bits;
}

/// A path of three nodes.
SkeletonGraph some_graph() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {1, 2, 1.5F}, {0, 1, 3, 4}, {1, 0, 2, 1}};
}

const std::vector<Imath::V3i> sizes{{0, 0, 0}, {1, 1, 1}, {8, 8, 8}, {9, 1, 17}, {40, 33, 21}};

TEST(Codec, ValuesComeBack) {
  EXPECT_EQ(Trip(std::uint8_t{200}).value, 200);
  EXPECT_EQ(Trip(-0.1).value, -0.1);
  EXPECT_EQ(Trip(std::string("a\0b", 3)).value, std::string("a\0b", 3));
  EXPECT_EQ(Trip(std::string()).value, "");
  EXPECT_EQ(Trip(Imath::V3i(1, -2, 3)).value, Imath::V3i(1, -2, 3));
  const std::vector<std::array<std::uint16_t, 2>> pairs{{1, 2}, {65535, 0}};
  EXPECT_EQ(Trip(pairs).value, pairs);
  EXPECT_EQ(Trip(std::vector<double>{}).value, std::vector<double>{});
}

TEST(Codec, MoreThanABlockComesBack) {
  std::mt19937 random(1);
  std::vector<std::uint32_t> noise(1 << 20);  // does not pack
  for (auto& v : noise) v = static_cast<std::uint32_t>(random());
  EXPECT_EQ(Trip(noise).value, noise);
  const std::vector<std::uint32_t> zeros(1 << 22);  // packs to next to nothing
  EXPECT_EQ(Trip(zeros).value, zeros);
}

TEST(Codec, GridsComeBack) {
  for (const Imath::V3i& size : sizes) {
    const Trip grid(some_grid(size));
    ASSERT_FALSE(grid.refusal) << grid.refusal->text;
    EXPECT_TRUE(same(*grid.value, some_grid(size)));
    const Trip bits(some_bits(size));
    ASSERT_FALSE(bits.refusal) << bits.refusal->text;
    EXPECT_EQ(*bits.value, some_bits(size));
  }
}

TEST(Codec, GraphsAndTransformsComeBack) {
  for (const SkeletonGraph& graph : {some_graph(), SkeletonGraph{}}) {
    const Trip back(graph);
    ASSERT_FALSE(back.refusal) << back.refusal->text;
    EXPECT_EQ(back.value->corners, graph.corners);
    EXPECT_EQ(back.value->radii, graph.radii);
    EXPECT_EQ(back.value->first, graph.first);
    EXPECT_EQ(back.value->neighbours, graph.neighbours);
  }
  const Trip transform(GridTransform{{1e7, -2, 0.5}, 1e-6});
  EXPECT_EQ(transform.value->origin, Imath::V3d(1e7, -2, 0.5));
  EXPECT_EQ(transform.value->voxel_size, 1e-6);
}

template <class T>
void expect_refused(const std::string& bytes, const char* what) {
  const auto trip = Trip<T>::of_bytes(bytes);
  ASSERT_TRUE(trip.refusal) << what;
  EXPECT_EQ(trip.refusal->fault, EntryFault::undecodable) << what;
}

TEST(Codec, SizesThatLieAreRefusedBeforeAnythingIsAllocated) {
  constexpr auto huge = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t n : {std::uint64_t{2}, huge, huge / 8 + 2, std::uint64_t{1} << 40}) {
    expect_refused<std::vector<double>>(bytes_of(n, 1.0), "a list");
    expect_refused<std::string>(bytes_of(n, 'x'), "a text");
  }
  for (const Imath::V3i& size : {Imath::V3i(-1, 1, 1), Imath::V3i(1, 1 << 17, 1),
                                 Imath::V3i(65536, 65536, 65536), Imath::V3i(3, 1, 1)}) {
    expect_refused<Grid3<float>>(bytes_of(size, 1.0F, 2.0F), "a grid");
  }
  for (const Imath::V3i& size :
       {Imath::V3i(8, 8, -8), Imath::V3i(9, 8, 8), Imath::V3i(65536, 65536, 65536)}) {
    expect_refused<BitGrid3>(bytes_of(size, BitBlock{}), "bits");
  }
  expect_refused<Grid3<float>>(bytes_of(Imath::V3i(1), 1.0F, 2.0F), "a grid and more");
}

TEST(Codec, BitsBeyondAGridAreRefused) {
  const Imath::V3i size(5, 6, 7);
  for (int bit = 0; bit < 512; ++bit) {
    BitBlock block;
    block.z[static_cast<std::size_t>(bit >> 6)] = std::uint64_t{1} << (bit & 63);
    const bool inside = (bit & 7) < size.x && (bit >> 3 & 7) < size.y && bit >> 6 < size.z;
    const auto trip = Trip<BitGrid3>::of_bytes(bytes_of(size, block));
    EXPECT_EQ(!trip.refusal, inside) << bit;
  }
}

TEST(Codec, GraphsThatBreakTheirPromisesAreRefused) {
  const auto broken = [](const char* what, const auto& change) {
    SkeletonGraph graph = some_graph();
    change(graph);
    EXPECT_TRUE(Trip(graph).refusal) << what;
  };
  broken("a radius too few", [](auto& g) { g.radii.pop_back(); });
  broken("a radius below 0", [](auto& g) { g.radii[0] = -1; });
  broken("a radius that is none", [](auto& g) { g.radii[0] = std::nanf(""); });
  broken("lists that do not begin at 0", [](auto& g) { g.first[0] = 1; });
  broken("lists that go back", [](auto& g) { g.first = {0, 3, 1, 4}; });
  broken("lists that end late", [](auto& g) { g.first.back() = 5; });
  broken("lists that end early", [](auto& g) { g.first.back() = 3; });
  broken("a list too few", [](auto& g) { g.first.pop_back(); });
  broken("a neighbour that is not there", [](auto& g) { g.neighbours[0] = 3; });
  broken("a node beside itself", [](auto& g) { g.neighbours[0] = 0; });
  broken("neighbours that descend", [](auto& g) { std::swap(g.neighbours[1], g.neighbours[2]); });
  broken("an edge of one direction", [](auto& g) { g.neighbours[0] = 2; });
  broken("edges without nodes", [](auto& g) {
    g = {};
    g.neighbours = {0};
  });
}

TEST(Codec, TransformsThatAreNoneAreRefused) {
  const auto inf = std::numeric_limits<double>::infinity();
  for (const GridTransform& t :
       {GridTransform{{0, 0, 0}, 0}, GridTransform{{0, 0, 0}, -1}, GridTransform{{0, 0, 0}, inf},
        GridTransform{{0, inf, 0}, 1}, GridTransform{{0, 0, std::nan("")}, 1}}) {
    EXPECT_TRUE(Trip(t).refusal);
  }
}

TEST(Codec, NoMutationOfTheContentDoesHarm) {
  std::mt19937 random(2);
  const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const SkeletonGraph graph = some_graph();
  const std::uint64_t n = 3, m = 4;
  const std::string whole =
      bytes_of(n) + std::string(reinterpret_cast<const char*>(graph.corners.data()), 36) +
      bytes_of(n) + std::string(reinterpret_cast<const char*>(graph.radii.data()), 12) +
      bytes_of(m) + std::string(reinterpret_cast<const char*>(graph.first.data()), 16) +
      bytes_of(m) + std::string(reinterpret_cast<const char*>(graph.neighbours.data()), 16);
  ASSERT_FALSE(Trip<SkeletonGraph>::of_bytes(whole).refusal) << "this is how a graph is written";
  for (int round = 0; round < 500; ++round) {
    std::string bytes = whole.substr(0, any(4) == 0 ? any(whole.size()) : whole.size());
    for (std::size_t k = any(4); k > 0 && !bytes.empty(); --k) {
      bytes[any(bytes.size())] = static_cast<char>(random());
    }
    const auto trip = Trip<SkeletonGraph>::of_bytes(bytes);
    if (trip.refusal) continue;
    for (std::uint32_t node = 0; node < trip.value->nodes(); ++node) {
      for (const std::uint32_t other : trip.value->of(node)) EXPECT_LT(other, trip.value->nodes());
    }
  }
}

TEST(Codec, AnOctreeComesBackAndHostileOnesAreRefused) {
  const std::vector<std::uint64_t> codes{0, 3, 9, 70, 511};
  for (const Octree& tree :
       {build_octree(codes, 3, Imath::V3d(1, -2, 3), 8), build_octree({}, 3, Imath::V3d(0.0), 1),
        build_octree(std::vector<std::uint64_t>{0}, 0, Imath::V3d(0.0), 1)}) {
    const Trip<Octree> trip(tree);
    ASSERT_TRUE(trip.value && !trip.refusal);
    EXPECT_EQ(trip.value->first, tree.first);
    EXPECT_EQ(trip.value->corner, tree.corner);
    ASSERT_EQ(trip.value->nodes.size(), tree.nodes.size());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      EXPECT_EQ(trip.value->nodes[i].centre, tree.nodes[i].centre);
      EXPECT_EQ(trip.value->nodes[i].octants, tree.nodes[i].octants);
      EXPECT_EQ(trip.value->nodes[i].first_child, tree.nodes[i].first_child);
    }
  }
  const auto written = [](double side, std::uint8_t levels, std::uint8_t roots,
                          const std::vector<std::uint8_t>& octants) {
    return bytes_of(Imath::V3d(0.0), side, levels, roots, std::uint64_t{octants.size()}) +
           std::string(octants.begin(), octants.end());
  };
  EXPECT_FALSE(Trip<Octree>::of_bytes(written(1, 2, 1, {3, 1, 128})).refusal);
  for (const std::string& hostile :
       {written(0, 1, 1, {1}), written(std::nan(""), 1, 1, {1}), written(1, 13, 1, {1}),
        written(1, 1, 2, {1, 1}), written(1, 1, 1, {0}), written(1, 2, 1, {3, 1}),
        written(1, 1, 1, {1, 1}), written(1, 3, 0, {1})}) {
    const auto trip = Trip<Octree>::of_bytes(hostile);
    ASSERT_TRUE(trip.refusal);
    EXPECT_EQ(trip.refusal->fault, EntryFault::undecodable);
  }
}

}  // namespace
}  // namespace lacuna
