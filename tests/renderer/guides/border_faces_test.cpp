// The light that paths found through the faces of a region's border (Noel 2015, 10.4.2): its sums,
// and the probabilities that follow.

#include "renderer/guides/border_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

/// By voxel and side.
using FaceLight = std::map<std::pair<std::uint32_t, int>, double>;

/// The borders of a scene's regions, face by face, and what guide: face_irradiance knows of them.
struct BorderScene {
  explicit BorderScene(const char* name)
      : scene([name] { return load(test::PathScene{name}); }, FaceIrradianceGuideSettings{}, 0,
              std::nullopt),
        labels(scene.context().space.regions()),
        lookup(scene.context().space.voxels().transform, labels.label),
        faces(FaceIrradianceGuideSettings{}),
        border(labels.regions.size()) {
    faces.prepare(scene.context(), lookup);
    const Grid3<std::uint32_t>& label = labels.label;
    for (std::uint32_t i = 0; i < label.count(); ++i) {
      if (label[i] == no_region) continue;
      for (std::uint8_t side = 0; side < 6; ++side) {
        const CrossedFace crossed = crossing({i, side});
        const bool inside = in_grid(crossed.to, label.size());
        if (!inside || label(crossed.to) != label[i]) border[label[i]].push_back({i, side});
      }
    }
  }

  /// As a ray crosses `face` that leaves the region.
  CrossedFace crossing(const VoxelFace& face) const {
    const Imath::V3i from = labels.label.voxel(face.voxel);
    return {from, from + Imath::V3i(face.normal()), face.axis(), 2.5};
  }
  double probability(std::uint32_t region, const VoxelFace& face, std::uint32_t near) const {
    const CrossedFace crossed = crossing(face);
    const bool inside = in_grid(crossed.to, labels.label.size());
    const std::uint32_t far = inside ? labels.label(crossed.to) : no_region;
    return faces.probability(region, crossed, near, far, anywhere);
  }
  VoxelFace draw(std::uint32_t region, Rng& rng) const {
    return faces.sample_face(region, anywhere, rng);
  }

  void expect_shares(const std::vector<FaceLight>& light) const {
    for (std::uint32_t r = 0; r < border.size(); ++r) {
      double sum = 0;
      for (const auto& [face, value] : light[r]) sum += value;
      ASSERT_EQ(faces.mass(r), sum > 0 ? 1 : 0) << "region " << r;
      if (!(sum > 0)) continue;
      for (const VoxelFace& f : border[r]) {
        const auto found = light[r].find({f.voxel, f.side});
        const double share = found == light[r].end() ? 0 : found->second / sum;
        EXPECT_NEAR(probability(r, f, r), share, 1e-6 * share + 1e-9);
        EXPECT_EQ(probability(r, f, r + 1), 0) << "left another region";
      }
    }
  }

  // Without thresholds, faces do not depend on the point.
  inline static const V3d anywhere{0.0};

  test::GuidedScene scene;
  const RegionLabels& labels;
  SurfaceLookup lookup;
  BorderFaceLight faces;
  std::vector<std::vector<VoxelFace>> border;  // of each region
};

void update(BorderScene& s) {
  for (std::uint32_t r = 0; r < s.border.size(); ++r) s.faces.update(r);
}

/// `n` samples of light through random faces of `region`, also added to `light`.
void add_random(BorderScene& s, std::uint32_t region, int n, Rng& rng, FaceLight& light) {
  const auto& border = s.border[region];
  const std::size_t few = std::max<std::size_t>(1, border.size() / 4);  // some several times
  for (int k = 0; k < n; ++k) {
    const VoxelFace& f = border[(rng.below(few) * 4 + 1) % border.size()];
    const double found = std::exp(12 * double(rng.next()) - 6);
    s.faces.add(region, f, found);
    light[{f.voxel, f.side}] += found;
  }
}

TEST(BorderFaces, HaveTheirShareOfTheLight) {
  Rng rng(51, 0, 0, Rng::Purpose::test);
  for (const char* name : {"ajar", "bends"}) {
    SCOPED_TRACE(name);
    BorderScene s(name);
    const auto regions = static_cast<std::uint32_t>(s.border.size());
    ASSERT_GT(regions, 3U);
    std::vector<FaceLight> light(regions);
    s.expect_shares(light);
    for (int iteration = 0; iteration < 4; ++iteration) {
      for (std::uint32_t r = 0; r < regions; r += 2) {  // others stay dark
        if (iteration == 0 || r % 4 == 0) add_random(s, r, 60, rng, light[r]);
      }
      update(s);
      s.expect_shares(light);
    }
    update(s);
    s.expect_shares(light);

    BorderFaceLight again(FaceIrradianceGuideSettings{});
    again.prepare(s.scene.context(), s.lookup);
    ByteWriter saved;
    s.faces.save(saved);
    ByteReader in(saved.bytes());
    again.load(in);
    s.faces = std::move(again);
    s.expect_shares(light);
  }
}

// What a path found through a face says nothing of the same square seen from the other side.
TEST(BorderFaces, OfOtherRegionsAreUntouched) {
  BorderScene s("ajar");
  const auto& portals = s.scene.context().space.portals();
  ASSERT_FALSE(portals.portals.empty());
  const Portal& p = portals.portals.front();
  const VoxelFace face = portals.face(p, 0);
  const auto beyond = static_cast<std::uint32_t>(s.labels.label.index(s.crossing(face).to));
  const VoxelFace twin{beyond, static_cast<std::uint8_t>(face.side ^ 1)};
  std::vector<FaceLight> light(s.border.size());
  s.faces.add(p.a, face, 6);
  light[p.a][{face.voxel, face.side}] = 6;
  update(s);
  s.expect_shares(light);
  EXPECT_EQ(s.probability(p.a, face, p.a), 1);
  EXPECT_EQ(s.faces.mass(p.b), 0);

  const auto other = std::find_if(s.border[p.b].begin(), s.border[p.b].end(),
                                  [&](const VoxelFace& f) { return !(f == twin); });
  ASSERT_NE(other, s.border[p.b].end());
  s.faces.add(p.b, *other, 1);
  light[p.b][{other->voxel, other->side}] = 1;
  update(s);
  s.expect_shares(light);
  EXPECT_EQ(s.probability(p.a, face, p.a), 1);
  EXPECT_EQ(s.probability(p.b, twin, p.b), 0);
}

TEST(BorderFaces, LeaveOutWhatIsNotFinite) {
  BorderScene s("ajar");
  std::vector<FaceLight> light(s.border.size());
  const auto& border = s.border[0];
  ASSERT_GT(border.size(), 4U);
  s.faces.add(0, border[0], 0.5);
  s.faces.add(0, border[1], 1.5);
  light[0][{border[0].voxel, border[0].side}] = 0.5;
  light[0][{border[1].voxel, border[1].side}] = 1.5;
  s.faces.add(0, border[1], HUGE_VAL);
  s.faces.add(0, border[3], std::nan(""));
  update(s);
  s.expect_shares(light);
}

TEST(BorderFaces, AreDrawnWithTheirProbability) {
  Rng rng(52, 0, 0, Rng::Purpose::test);
  BorderScene s("ajar");
  std::vector<FaceLight> light(s.border.size());
  for (std::uint32_t r = 0; r < s.border.size(); ++r) add_random(s, r, 200, rng, light[r]);
  update(s);
  constexpr int draws = 20000;
  for (std::uint32_t r = 0; r < s.border.size(); ++r) {
    SCOPED_TRACE(r);
    FaceLight drawn;
    for (int k = 0; k < draws; ++k) {
      const VoxelFace f = s.draw(r, rng);
      ++drawn[{f.voxel, f.side}];
    }
    std::vector<double> observed, expected;
    for (const VoxelFace& f : s.border[r]) {
      observed.push_back(drawn[{f.voxel, f.side}]);
      expected.push_back(draws * s.probability(r, f, r));
    }
    EXPECT_EQ(drawn.size(), s.border[r].size()) << "faces that are not of the border";
    const auto result = statistics::chi_square_test(observed, expected);
    EXPECT_GT(result.p, statistics::sidak(1e-6, s.border.size())) << result.message;
  }
}

TEST(BorderFaces, RefuseTheLightOfOtherBorders) {
  BorderScene s("ajar"), other("bends");
  ByteWriter saved;
  other.faces.save(saved);
  ByteReader in(saved.bytes());
  EXPECT_THROW(s.faces.load(in), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
