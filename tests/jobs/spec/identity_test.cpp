#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "jobs/spec/identity.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/reference_spec.h"
#include "random_settings.h"
#include "table_keys.h"

namespace lacuna {
namespace {

/// For each key of the job, a change of it alone.
const std::map<std::string, std::function<void(JobSpec&)>> changes{
    {"scene", [](JobSpec& s) { s.scene.push_back('b'); }},
    {"camera", [](JobSpec& s) { s.camera.name.push_back('c'); }},
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
    {"time", [](JobSpec& s) { s.time = 0.5; }},
    {"animation", [](JobSpec& s) { s.animation = "walk"; }},
    {"light_units", [](JobSpec& s) { s.light_units = LightUnits::photometric; }},
    {"variant", [](JobSpec& s) { s.variant = "red"; }},
    {"material", [](JobSpec& s) { s.material = MaterialChange{.name = "floor"}; }},
    {"seed", [](JobSpec& s) { s.seed = 2; }},
    {"sampler", [](JobSpec& s) { s.sampler = Sampler::independent; }},
    {"shards", [](JobSpec& s) { s.shards = 2; }},
    {"shard", [](JobSpec& s) { s.shard = 1; }},
    {"threads", [](JobSpec& s) { s.threads = 2; }},
    {"layers", [](JobSpec& s) { s.layers = {ImageLayer::albedo}; }},
    {"pixel_filter", [](JobSpec& s) { s.pixel_filter = PixelFilter::tent; }},
    {"pixel_type", [](JobSpec& s) { s.pixel_type = PixelType::half_float; }},
    {"checkpoint_seconds", [](JobSpec& s) { s.checkpoint_seconds = 11; }},
    {"exclusive", [](JobSpec& s) { s.exclusive = true; }},
};

/// The keys of a job that change a name of it, when each is changed alone.
template <class Name>
std::set<std::string> keys_that_change(Name name) {
  JobSpec base;
  base.scene = "a.glb";
  base.reference = "auto";
  std::set<std::string> found;
  for (const std::string& key : keys_of(base)) {
    EXPECT_TRUE(changes.contains(key)) << "a new key needs a case here: " << key;
    if (!changes.contains(key)) continue;
    JobSpec changed = base;
    changes.at(key)(changed);
    EXPECT_NE(changed, base) << key;
    if (name(changed) != name(base)) found.insert(key);
  }
  return found;
}

TEST(Identity, is_changed_by_what_decides_and_by_nothing_else) {
  EXPECT_EQ(
      keys_that_change([](const JobSpec& s) { return picture_key(s); }),
      (std::set<std::string>{"scene", "camera", "resolution", "integrator", "analysis",
                             "environment", "seed", "sampler", "pixel_filter", "crop", "particles",
                             "material", "time", "animation", "variant", "light_units"}));
  EXPECT_EQ(keys_that_change([](const JobSpec& s) { return picture_name(s); }),
            (std::set<std::string>{"scene", "camera", "resolution", "integrator", "environment",
                                   "reference", "pixel_filter", "crop", "particles", "material",
                                   "time", "animation", "variant", "light_units"}));
  EXPECT_EQ(
      keys_that_change([](const JobSpec& s) { return preparation_key(s); }),
      (std::set<std::string>{"scene", "camera", "analysis", "environment", "particles", "material",
                             "threads", "time", "animation", "variant", "light_units"}));
}

TEST(Identity, lists_name_keys_of_the_table) {
  const auto keys = keys_of(JobSpec{});
  for (const KeyList list :
       {KeyList(not_in_the_picture), KeyList(not_in_a_reference), KeyList(not_in_a_preparation)}) {
    for (const std::string_view key : list) {
      EXPECT_NE(std::find(keys.begin(), keys.end(), key), keys.end()) << key;
    }
  }
  const auto lengths = keys_of(LightLengths{});
  for (const std::string_view key : not_in_the_light) {
    EXPECT_NE(std::find(lengths.begin(), lengths.end(), key), lengths.end()) << key;
  }
}

/// A job of which no list has heard everything.
struct FutureJob : JobSpec {
  std::string weather = "clear";
};
template <class V>
void describe(V& v, FutureJob& s) {
  describe(v, static_cast<JobSpec&>(s));
  v("weather", s.weather, {.doc = "a key of tomorrow"});
}

FutureJob job_in(const std::string& weather, const std::string& reference) {
  FutureJob job;
  job.scene = "a.glb";
  job.reference = reference;
  job.weather = weather;
  return job;
}

TEST(Identity, a_key_that_no_list_names_is_part_of_all_three) {
  for (const char* reference : {"", "auto", "r.exr"}) {
    const FutureJob clear = job_in("clear", reference), fog = job_in("fog", reference);
    EXPECT_NE(picture_key(fog), picture_key(clear)) << reference;
    EXPECT_NE(picture_name(fog), picture_name(clear)) << reference;
    EXPECT_NE(preparation_key(fog), preparation_key(clear)) << reference;
    EXPECT_EQ(reference_spec(fog).weather, "fog");
    EXPECT_NE(picture_key(reference_spec(fog)), picture_key(reference_spec(clear)));
  }
}

/// Changes the number of one name in a table.
struct OneMore {
  std::string_view name;
  void operator()(std::string_view key, int& member, const Field&) const {
    if (key == name) ++member;
  }
};

TEST(Identity, every_path_length_is_part_of_the_reference_unless_it_is_listed) {
  for (const std::string& key : keys_of(LightLengths{})) {
    LightLengths longer;
    OneMore visitor{key};
    describe(visitor, longer);
    const bool listed =
        std::find(not_in_the_light.begin(), not_in_the_light.end(), key) != not_in_the_light.end();
    const auto reference = [](auto settings, const PathLengths& lengths) {
      static_cast<PathLengths&>(settings) = lengths;
      return reference_integrator(settings);
    };
    const JobIntegrator plain = reference(PathSettings{}, PathLengths{});
    EXPECT_EQ(reference(PathSettings{}, longer) == plain, listed) << key;
    EXPECT_EQ(reference(LightSettings{}, longer) == plain, listed) << key;
    EXPECT_EQ(reference(BdptSettings{}, longer) == plain, listed) << key;
    EXPECT_EQ(reference(ManyLightsSettings{}, longer) == plain, listed) << key;
  }
}

TEST(Identity, without_leaves_the_rest_as_it_is) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const JobSpec job = random_job(seed);
    EXPECT_EQ(without(job, {}), job);
    JobSpec plain = job;
    plain.label.clear();
    plain.budget = {};
    constexpr std::array<std::string_view, 2> keys{"label", "budget"};
    EXPECT_EQ(without(job, keys), plain);
  }
  EXPECT_THROW(without(JobSpec{}, {}), BadJob) << "a job needs a scene";
}

TEST(PictureKey, is_the_same_for_the_same_job_and_fit_for_a_file_name) {
  JobSpec spec;
  spec.scene = "a.glb";
  const std::string key = picture_key(spec);
  EXPECT_EQ(key, picture_key(parse_job(write_job(spec))));
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(key.find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(PictureKey, sees_settings_of_any_depth) {
  JobSpec a, b;
  b.integrator = InspectSettings{};
  JobSpec c = b;
  std::get<InspectSettings>(c.integrator).show = InspectQuantity::depth;
  JobSpec d, e;
  d.environment = EnvironmentSettings{"e.exr", 1, 0};
  e.environment = EnvironmentSettings{"e.exr", 1, 1e-12};
  JobSpec f, g;
  f.analysis.node_radius = NodeRadius::voxel;
  g.analysis.cluster_alpha = 0.1;
  std::set<std::string> keys;
  for (const JobSpec& job : {a, b, c, d, e, f, g}) keys.insert(picture_key(job));
  EXPECT_EQ(keys.size(), 7u);
}

}  // namespace
}  // namespace lacuna
