#include <algorithm>
#include <random>

#include "renderer/gltf/gltf_guard.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/integrators/path_tracer.h"
#include "renderer/path/guide.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"
#include "tests/renderer/gltf/glb_frame.h"
#include "tests/renderer/gltf/scene_promises.h"

// A .glb or .gltf, every other one at a time of its animations: refused, or a scene that keeps the
// promises of SceneData, is built, and gives a small picture without a value that is not finite.

namespace lacuna::fuzz {
namespace {

const ThreadPool& pool() {
  static const ThreadPool one(1);
  return one;
}

void render(SceneData data) {
  if (data.cameras.empty()) return;
  constexpr int side = 4;
  const Camera camera(data.cameras.front(), side, side);
  PathSettings settings;
  settings.max_depth = 4;
  PathTracer integrator(settings, Guide());
  const Scene scene(std::move(data), integrator.needs(), std::nullopt, pool());
  Image image(side, side);
  const std::function<bool()> never = [] { return false; };
  const Counters counters = integrator.iterate({scene, camera, pool(), 1, 0, never}, image);
  expect(counters.samples == side * side, "every pixel is sampled");
  for (const Rgb& p : image.pixels) expect(is_finite(p), "nothing non-finite enters a picture");
}

/// Changes one of the chunks and puts them together again: without this nearly every change of a
/// length ends at the header.
std::size_t mutate_chunk(std::uint8_t* data, std::size_t size, std::size_t max_size,
                         bool json_chunk) {
  const gltf::Framing framing = gltf::check_framing({data, size});
  const auto* bin_begin = framing.json.data() + framing.json.size() + 8;
  std::vector<std::uint8_t> json(framing.json.begin(), framing.json.end());
  std::vector<std::uint8_t> bin;
  if (framing.bin_bytes > 0) bin.assign(bin_begin, bin_begin + framing.bin_bytes);
  std::vector<std::uint8_t>& changed = json_chunk || bin.empty() ? json : bin;
  const std::size_t others = size - changed.size();
  constexpr std::size_t slack = 16;  // padding and a header
  if (others + slack >= max_size) return LLVMFuzzerMutate(data, size, max_size);
  const std::size_t before = changed.size();
  changed.resize(std::max(before, max_size - others - slack));
  changed.resize(LLVMFuzzerMutate(changed.data(), before, changed.size()));
  const auto out = test::frame_glb({json.begin(), json.end()}, std::move(bin));
  if (out.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::copy(out.begin(), out.end(), data);
  return out.size();
}

}  // namespace
}  // namespace lacuna::fuzz

LACUNA_FUZZ_MUTATOR(glb) {
  std::minstd_rand random(seed);
  const auto choice = random() % 10;
  if (choice == 0) return LLVMFuzzerMutate(data, size, max_size);
  try {
    if (!lacuna::gltf::check_framing({data, size}).binary) {
      return LLVMFuzzerMutate(data, size, max_size);
    }
    return lacuna::fuzz::mutate_chunk(data, size, max_size, choice > 3);
  } catch (const lacuna::SceneError&) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
}

LACUNA_FUZZ_TARGET(glb) {
  using namespace lacuna;
  static const fuzz::InputFile input("input.glb");
  try {
    SceneChoice time;
    if (size / 4 % 2 == 1) time.seconds = 0.5;
    SceneData scene = load_gltf(input.holding({data, size}), nullptr, time);
    fuzz::expect(test::broken_promise(scene).empty(), "a scene keeps the promises of SceneData");
    fuzz::render(std::move(scene));
  } catch (const SceneError&) {
  }
  return 0;
}
