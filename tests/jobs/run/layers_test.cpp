// What an integrator fills beside the picture, from the first iteration to image.exr.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "analysis/space/memory_limit.h"
#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "jobs/run/results.h"
#include "renderer/core/rng.h"
#include "renderer/images/image_read.h"
#include "tests/jobs/run/silent_observer.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

const std::vector<std::string> all_names{"strategies.s0t2", "strategies.s1t1",
                                         "strategies_unweighted.s0t2", "distributions.paired"};

/// What Noise puts into an image in one iteration; key 0: the picture, else the layers in turn.
Image noise_of(std::uint64_t seed, std::uint64_t iteration, std::size_t key) {
  Image image(4, 2);
  Rng rng(seed, iteration, key, Rng::Purpose::test);
  for (Rgb& p : image.pixels) {
    p.x = rng.next();
    p.y = -rng.next();
    p.z = 1e5F * rng.next();
  }
  return image;
}

/// Noise in the picture and in every layer. It asks whether to stop once all is filled.
class Noise final : public Integrator {
 public:
  explicit Noise(std::size_t images = all_names.size())
      : names_(all_names.begin(), all_names.begin() + std::ptrdiff_t(images)) {}

  SceneNeeds needs() const override { return {}; }
  std::vector<std::string> layers(std::span<const ImageLayer> wanted) override {
    ++asked;
    asked_for.assign(wanted.begin(), wanted.end());
    return names_;
  }
  Counters iterate(const IterationContext& context, Image& image) override {
    EXPECT_EQ(context.layers.size(), names_.size());
    fill(context, image, 0);
    for (std::size_t k = 0; k < context.layers.size(); ++k) fill(context, context.layers[k], k + 1);
    if (context.stop()) throw IterationStopped{};
    return {};
  }

  int asked = 0;
  std::vector<ImageLayer> asked_for;
  float brightness = 1;

 private:
  void fill(const IterationContext& context, Image& image, std::size_t key) const {
    Image values = noise_of(context.seed, context.iteration, key);
    EXPECT_EQ(image.width, values.width);
    EXPECT_EQ(image.height, values.height);
    for (const Rgb& p : image.pixels) EXPECT_EQ(p, Rgb(0, 0, 0));
    for (Rgb& p : values.pixels) p *= brightness;
    image.pixels.swap(values.pixels);
  }
  std::vector<std::string> names_;
};

SceneData one_triangle() {
  SceneData data;
  data.materials.emplace_back();
  Mesh mesh;
  mesh.positions = {V3f(0, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  data.meshes.push_back(std::move(mesh));
  return data;
}

/// Jobs of four by two pixels, each in a folder of its own.
class Layers : public testing::Test {
 protected:
  Layers() {
    spec.scene = "a.glb";
    spec.resolution = {4, 2};
    spec.budget.iterations = 40;
    spec.layers = {ImageLayer::strategies, ImageLayer::variance};
  }

  JobFolder create(const std::string& name) { return JobFolder::create(temp.path() / name, spec); }
  /// Runs the loop until `patience` questions were asked; true: to the end, with its results.
  bool run(const JobFolder& folder, Noise& noise, int patience = 1 << 30) {
    int left = patience;
    const std::function<bool()> interrupted = [&] { return left-- <= 0; };
    const RenderTask task{folder,  spec,        scene,    camera, pool,      noise,
                          nullptr, interrupted, observer, phases, "content", seconds_left};
    RenderLoop loop(task);
    loop.resume();
    const bool done = loop.run() == RenderLoop::End::spent;
    unsaved = loop.unsaved_iterations();
    if (!done) return false;
    write_results(task, loop);
    return true;
  }
  static std::vector<float> layer(const JobFolder& folder, const std::string& name) {
    return read_float_image(folder.file("image.exr"), name).rgb;
  }

  TemporaryFolder temp;
  JobSpec spec;
  ThreadPool pool{2};
  Scene scene{one_triangle(), {}, std::nullopt, pool};
  Camera camera{CameraData{}, 4, 2};
  SilentObserver observer;
  PhaseSeconds phases;
  std::function<double()> seconds_left;  ///< of each stop
  std::uint64_t unsaved = 0;             ///< iterations that the last run has left in no checkpoint
};

TEST_F(Layers, AreMeansInImageExrAndForThePageByTheirNames) {
  const JobFolder folder = create("job");
  Noise noise;
  ASSERT_TRUE(run(folder, noise));
  EXPECT_EQ(noise.asked, 1);
  EXPECT_EQ(noise.asked_for, named_layers(spec.layers));
  for (std::size_t k = 0; k < all_names.size(); ++k) {
    std::vector<double> expected(3 * 8, 0.0);
    for (std::uint64_t i = 0; i < 40; ++i) {
      const Image values = noise_of(spec.seed, i, k + 1);
      for (std::size_t v = 0; v < expected.size(); ++v) {
        expected[v] += double(values.pixels[v / 3][int(v % 3)]) / 40;
      }
    }
    const std::vector<float> found = layer(folder, all_names[k]);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t v = 0; v < found.size(); ++v) {
      EXPECT_NEAR(double(found[v]), expected[v], 1e-6 * std::abs(expected[v])) << all_names[k];
    }
  }
  const auto index = parse_own_sorted(read_file(folder.file("layers.json"), 1 << 20));
  std::vector<std::string> names;
  for (const auto& l : index.at("layers")) {
    names.push_back(l.at("name"));
    EXPECT_EQ(l.at("channels"), (nlohmann::json{"R", "G", "B"}));
  }
  std::vector<std::string> expected{"", "variance"};
  expected.insert(expected.end(), all_names.begin(), all_names.end());
  EXPECT_EQ(names, expected);
  EXPECT_TRUE(phases.contains("layers"));
}

TEST_F(Layers, VarianceIsKeptAtEveryBrightness) {
  const auto variance = [&](const std::string& name, float brightness) {
    Noise noise;
    noise.brightness = brightness;
    const JobFolder folder = create(name);
    run(folder, noise);
    const FloatImage file = read_float_image(folder.file("image.exr"), "variance");
    std::vector<double> values(file.rgb.begin(), file.rgb.end());
    const double scale = std::stod(file.attributes.at("lacuna:variance_scale"));
    for (double& v : values) v /= scale * double(brightness) * double(brightness);
    return std::pair(values, scale);
  };
  const auto [plain, one] = variance("plain", 1);
  EXPECT_EQ(one, 1);
  for (const float brightness : {0x1p-20F, 0x1p-100F, 0x1p80F}) {
    const auto [scaled, scale] = variance(std::to_string(std::ilogb(brightness)), brightness);
    EXPECT_EQ(scale == 1, brightness == 0x1p-20F);
    ASSERT_EQ(scaled.size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
      EXPECT_GT(plain[i], 0);
      EXPECT_NEAR(scaled[i] / plain[i], 1, 1e-6) << brightness;
    }
  }
  spec.pixel_type = PixelType::half_float;
  Noise noise;
  noise.brightness = 1e-4F;
  const JobFolder halves = create("halves");
  run(halves, noise);
  const std::vector<float> stored = layer(halves, "variance");
  EXPECT_GT(*std::max_element(stored.begin(), stored.end()), 0.5F);
}

TEST_F(Layers, InterruptedAnywhereTheyGoOnToTheSameBits) {
  const JobFolder whole = create("whole"), parts = create("parts");
  Noise noise;
  run(whole, noise);
  int stops = 0;
  // With an odd number of questions the iteration is stopped when all its images are filled.
  for (int patience = 1; !run(parts, noise, patience); patience += 2) ASSERT_LT(++stops, 100);
  EXPECT_GT(stops, 5);
  EXPECT_TRUE(observer.warnings.empty());
  for (const std::string& name : all_names) EXPECT_EQ(layer(parts, name), layer(whole, name));
  EXPECT_EQ(layer(parts, ""), layer(whole, ""));
}

TEST_F(Layers, StoppedWithoutTimeToWriteTheyGoOnFromTheCheckpointBefore) {
  const JobFolder whole = create("whole"), parts = create("parts");
  Noise noise;
  run(whole, noise);
  ASSERT_FALSE(run(parts, noise, 9));
  EXPECT_EQ(unsaved, 0U);
  const auto file = parts.file("checkpoint.bin");
  const std::string before = read_file(file, 1 << 20);
  const std::int64_t iteration = parts.read_progress()->iteration;
  EXPECT_GT(iteration, 0);
  for (const double seconds : {0.0, -1.0}) {
    seconds_left = [seconds] { return seconds; };
    ASSERT_FALSE(run(parts, noise, 12));
    EXPECT_GT(unsaved, 0U);
    EXPECT_EQ(read_file(file, 1 << 20), before);
    EXPECT_EQ(parts.read_progress()->iteration, iteration) << "what the checkpoint holds";
  }
  seconds_left = [] { return 100.0; };
  ASSERT_FALSE(run(parts, noise, 12));
  EXPECT_EQ(unsaved, 0U);
  EXPECT_GT(parts.read_progress()->iteration, iteration);
  ASSERT_TRUE(run(parts, noise));
  EXPECT_TRUE(observer.warnings.empty());
  for (const std::string& name : all_names) EXPECT_EQ(layer(parts, name), layer(whole, name));
  EXPECT_EQ(layer(parts, ""), layer(whole, ""));
  EXPECT_TRUE(names_in(parts.dir()).contains("checkpoint.bin"));
}

TEST_F(Layers, OfACheckpointThatAreNotThoseOfTheJobBeginAnew) {
  const JobFolder folder = create("job"), whole = create("whole");
  Noise four, two(2), none(0);
  run(whole, two);
  ASSERT_FALSE(run(folder, four, 7));
  ASSERT_FALSE(run(folder, none, 7));
  ASSERT_EQ(observer.warnings.size(), 1U);
  EXPECT_NE(observer.warnings[0].find("other layers"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.file("checkpoint.unusable")));
  ASSERT_TRUE(run(folder, two));
  EXPECT_EQ(observer.warnings.size(), 2U);
  for (const char* name : {"", "strategies.s0t2", "strategies.s1t1"}) {
    EXPECT_EQ(layer(folder, name), layer(whole, name)) << name;
  }
}

TEST_F(Layers, ThatAreMadeAtTheEndMayChangeBetweenRuns) {
  const JobFolder folder = create("job");
  Noise noise;
  ASSERT_FALSE(run(folder, noise, 7));
  spec.layers = {ImageLayer::strategies, ImageLayer::halves};
  ASSERT_TRUE(run(folder, noise));
  EXPECT_TRUE(observer.warnings.empty());
  EXPECT_FALSE(layer(folder, "even").empty());
}

TEST_F(Layers, ThatNobodyAskedForCostNothing) {
  const JobFolder folder = create("job");
  Noise none(0);
  ASSERT_TRUE(run(folder, none));
  EXPECT_FALSE(phases.contains("layers"));
}

}  // namespace
}  // namespace lacuna
