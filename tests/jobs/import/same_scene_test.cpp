// One scene as a file of Mitsuba and as files of pbrt: the same triangles, the same picture.

#include <gtest/gtest.h>

#include <algorithm>

#include "jobs/import/mitsuba/read_mitsuba.h"
#include "jobs/import/pbrt/read_pbrt.h"
#include "jobs/import/scene_write.h"
#include "tests/renderer/images/test_images.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

const std::string mitsuba_file = R"(<scene version="0.6.0">
  <integrator type="path"><integer name="maxDepth" value="4"/></integrator>
  <sensor type="perspective"><float name="fov" value="50"/><string name="fovAxis" value="y"/>
    <transform name="toWorld"><lookat origin="1, 1, 5" target="0, .8, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="48"/><integer name="height" value="32"/></film>
  </sensor>
  <bsdf type="twosided" id="picture"><bsdf type="diffuse"><texture name="reflectance" type="bitmap">
    <string name="filename" value="four.png"/><string name="filterType" value="nearest"/>
    </texture></bsdf></bsdf>
  <bsdf type="twosided" id="blue"><bsdf type="diffuse">
    <rgb name="reflectance" value=".2, .3, .8"/></bsdf></bsdf>
  <shape type="rectangle"><ref id="picture"/><transform name="toWorld">
    <scale value="2"/><rotate x="1" angle="-90"/><translate z=".5"/></transform></shape>
  <shape type="sphere"><ref id="blue"/><point name="center" x="-.8" y=".5" z="0"/>
    <float name="radius" value=".5"/></shape>
  <shape type="disk"><ref id="blue"/><transform name="toWorld">
    <scale value=".7"/><rotate y="1" angle="25"/><translate x="1" y=".8" z="-1"/></transform></shape>
  <shape type="rectangle"><ref id="blue"/><transform name="toWorld">
    <scale x=".3" y=".5"/><rotate x="1" angle="60"/><translate x="-.2" y="2" z="1"/></transform>
    <emitter type="area"><rgb name="radiance" value="9, 7, 5"/></emitter></shape>
  <emitter type="point"><point name="position" x="-2" y="1" z="3"/>
    <rgb name="intensity" value="4, 5, 6"/></emitter>
  <emitter type="constant"><rgb name="radiance" value=".1, .2, .3"/></emitter>
</scene>)";

/// pbrt's own space is left-handed: either the camera mirrors it, or the world is written mirrored.
const std::pair<std::string, std::string> right_handed{"Scale -1 1 1 LookAt 1 1 5", ""};
const std::pair<std::string, std::string> left_handed{"LookAt -1 1 5", "Scale -1 1 1 "};

std::string pbrt_file(const std::pair<std::string, std::string>& handed) {
  const auto& [camera, world] = handed;
  return R"(Film "rgb" "integer xresolution" 48 "integer yresolution" 32)"
         "\n" +
         camera +
         R"(  0 .8 0  0 1 0  Camera "perspective" "float fov" 50
Integrator "volpath" "integer maxdepth" 3
WorldBegin )" +
         world +
         R"(
Texture "four" "spectrum" "imagemap" "string filename" "four.png" "string filter" "point"
MakeNamedMaterial "picture" "string type" "diffuse" "texture reflectance" "four"
MakeNamedMaterial "blue" "string type" "diffuse" "rgb reflectance" [.2 .3 .8]
LightSource "infinite" "rgb L" [.1 .2 .3]
LightSource "point" "rgb I" [4 5 6] "point3 from" [-2 1 3]
AttributeBegin
  NamedMaterial "picture"
  Translate 0 0 .5 Rotate -90 1 0 0 Scale 2 2 2
  Shape "bilinearmesh" "point3 P" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] "point2 uv" [0 1 1 1 0 0 1 0]
AttributeEnd
NamedMaterial "blue"
AttributeBegin
  Translate 1 .8 -1 Rotate 25 0 1 0
  Shape "disk" "float radius" .7
AttributeEnd
AttributeBegin
  Translate -.8 .5 0
  Shape "sphere" "float radius" .5
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [9 7 5]
  Translate -.2 2 1 Rotate 60 1 0 0 Scale .3 .5 1
  Shape "trianglemesh" "point3 P" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] "integer indices" [0 1 2 0 2 3]
AttributeEnd
)";
}

/// Centre and area vector of each triangle, ordered by a projection of the centre.
struct PlacedTriangle {
  double at = 0;
  V3d centre, area;
  bool operator<(const PlacedTriangle& o) const { return at < o.at; }
};
std::vector<PlacedTriangle> triangles_of(const SceneData& scene) {
  EXPECT_TRUE(scene.instances.empty());
  std::vector<PlacedTriangle> out;
  for (const Mesh& mesh : scene.placed_meshes()) {
    for (const auto& t : mesh.triangles) {
      const V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
      const V3d centre = (a + b + c) / 3;
      out.push_back({centre.dot(V3d(.6, .64, .48)), centre, (b - a).cross(c - a) / 2});
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Whether each of `some` is one of `all`, up to rounding.
bool are_among(const std::vector<PlacedTriangle>& some, const std::vector<PlacedTriangle>& all) {
  constexpr double rounding = 1e-5;
  const auto is_there = [&](const PlacedTriangle& t) {
    auto o = std::lower_bound(all.begin(), all.end(), PlacedTriangle{t.at - rounding, {}, {}});
    for (; o != all.end() && o->at <= t.at + rounding; ++o) {
      if ((o->centre - t.centre).length() + (o->area - t.area).length() < rounding) return true;
    }
    return false;
  };
  return std::all_of(some.begin(), some.end(), is_there);
}

class SameScene : public testing::Test {
 protected:
  SameScene() {
    folder_.write("four.png",
                  test::encode8(2, 2, 3, {200, 40, 40, 40, 200, 40, 40, 40, 200, 220, 220, 60}));
  }
  ImportedScene mitsuba() const {
    return read_mitsuba(folder_.write("m.xml", mitsuba_file), MissingFiles::refuse);
  }
  ImportedScene pbrt(const std::string& text) const {
    return read_pbrt(folder_.write("p.pbrt", text), MissingFiles::refuse);
  }
  SceneData written(const ImportedScene& scene, const std::string& name) const {
    write_imported_scene(scene, folder_ / name);
    return load_gltf(folder_ / (name + "/scene.glb"));
  }
  test::Rendering rendered(const ImportedScene& scene, const std::string& name,
                           std::uint64_t seed) const {
    SceneData data = written(scene, name);
    PathSettings path;
    path.max_depth = *scene.picture.max_depth;
    return test::render(std::move(data),
                        {.integrator = path,
                         .width = 48,
                         .height = 32,
                         .iterations = 64,
                         .seed = seed,
                         .environment = EnvironmentImage{folder_ / (name + "/environment.exr")}});
  }

  TemporaryFolder folder_;
};

TEST_F(SameScene, HasTheSameTriangles) {
  const auto expected = triangles_of(written(mitsuba(), "m"));
  for (const auto& handed : {right_handed, left_handed}) {
    const auto found = triangles_of(written(pbrt(pbrt_file(handed)), "p"));
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_TRUE(are_among(found, expected)) << handed.first;
    EXPECT_TRUE(are_among(expected, found)) << handed.first;
  }
}

TEST_F(SameScene, GivesTheSamePicture) {
  const ImportedScene first = mitsuba();
  EXPECT_EQ(*first.picture.max_depth, 4);
  const auto expected = rendered(first, "m", 1);
  test::expect_same_picture(rendered(pbrt(pbrt_file(right_handed)), "p", 2), expected, 5e-3);
  test::expect_same_picture(rendered(pbrt(pbrt_file(left_handed)), "q", 3), expected, 5e-3);
}

}  // namespace
}  // namespace lacuna
