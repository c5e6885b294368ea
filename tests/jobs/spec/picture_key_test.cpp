#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>
#include <string>

#include "jobs/spec/job_json.h"
#include "table_keys.h"

namespace lacuna {
namespace {

/// For each key of the job, a change of it alone.
const std::map<std::string, std::function<void(JobSpec&)>> changes{
    {"scene", [](JobSpec& s) { s.scene.push_back('b'); }},
    {"camera", [](JobSpec& s) { s.camera.push_back('c'); }},
    {"label", [](JobSpec& s) { s.label.push_back('x'); }},
    {"resolution",
     [](JobSpec& s) {
       s.resolution = {512, 511};
     }},
    {"crop",
     [](JobSpec& s) {
       s.crop = CropSettings{{1024, 1024}, {0, 0}};
     }},
    {"integrator", [](JobSpec& s) { std::get<PathSettings>(s.integrator).max_depth = 7; }},
    {"budget", [](JobSpec& s) { s.budget.iterations = 3; }},
    {"reference", [](JobSpec& s) { s.reference.push_back('r'); }},
    {"reference_iterations", [](JobSpec& s) { s.reference_iterations = 3; }},
    {"analysis", [](JobSpec& s) { s.analysis.resolution = 129; }},
    {"environment",
     [](JobSpec& s) {
       s.environment = EnvironmentSettings{"e.exr", 1, 0};
     }},
    {"particles", [](JobSpec& s) { s.particles = ParticleSettings{.count = 9, .power = 1}; }},
    {"material", [](JobSpec& s) { s.material = MaterialChange{.name = "floor"}; }},
    {"seed", [](JobSpec& s) { s.seed = 2; }},
    {"threads", [](JobSpec& s) { s.threads = 2; }},
    {"layers", [](JobSpec& s) { s.layers = {ImageLayer::albedo}; }},
    {"pixel_filter", [](JobSpec& s) { s.pixel_filter = PixelFilter::tent; }},
    {"pixel_type", [](JobSpec& s) { s.pixel_type = PixelType::half_float; }},
    {"checkpoint_seconds", [](JobSpec& s) { s.checkpoint_seconds = 11; }},
    {"exclusive", [](JobSpec& s) { s.exclusive = true; }},
};

const std::set<std::string> decides_the_picture{
    "scene", "camera",       "resolution", "integrator", "analysis", "environment",
    "seed",  "pixel_filter", "crop",       "particles",  "material"};

TEST(PictureKey, ChangesWithWhatDecidesThePixelsAndWithNothingElse) {
  JobSpec base;
  base.scene = "a.glb";
  for (const std::string& name : keys_of(base)) {
    ASSERT_TRUE(changes.contains(name)) << "a new key needs a case here: " << name;
    JobSpec changed = base;
    changes.at(name)(changed);
    ASSERT_NE(changed, base) << name;
    EXPECT_EQ(picture_key(changed) != picture_key(base), decides_the_picture.contains(name))
        << name;
  }
}

TEST(PictureKey, IsTheSameForTheSameJobAndFitForAFileName) {
  JobSpec spec;
  spec.scene = "a.glb";
  const std::string key = picture_key(spec);
  EXPECT_EQ(key, picture_key(parse_job(write_job(spec))));
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(key.find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(PictureKey, SeesSettingsOfAnyDepth) {
  JobSpec a, b;
  b.integrator = InspectSettings{};
  JobSpec c = b;
  std::get<InspectSettings>(c.integrator).show = InspectQuantity::depth;
  JobSpec d, e;
  d.environment = EnvironmentSettings{"e.exr", 1, 0};
  e.environment = EnvironmentSettings{"e.exr", 1, 1e-12};
  const std::set<std::string> keys{picture_key(a), picture_key(b), picture_key(c), picture_key(d),
                                   picture_key(e)};
  EXPECT_EQ(keys.size(), 5u);
}

}  // namespace
}  // namespace lacuna
