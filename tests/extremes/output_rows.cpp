// What is written: films of every shape, and floats of half the size.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "renderer/images/image_read.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

const std::function<bool()> to_the_end = [] { return false; };
constexpr double largest_half = 65504;

/// image.exr of a job that is done; all finite, nothing rejected.
std::vector<double> done_image(const JobFolder& folder, Check& check) {
  const auto report = parse_own_sorted(content_of(folder.file("report.json")));
  check.require(report.at("counts").at("rejected") == 0, "samples were rejected");
  const FloatImage image = read_float_image(folder.file("image.exr"));
  std::vector<double> rgb(image.rgb.begin(), image.rgb.end());
  for (const double v : rgb) check.require(std::isfinite(v), "a pixel is not finite");
  return rgb;
}

/// In a furnace every film shows the same mean, so a whole job of any shape has a known answer.
Row film(int width, int height) {
  return {fmt::format("a film of {} x {}", width, height),
          [=](Stage& stage, const Method& method, Check& check) {
            const Furnace f{.albedo = 0.5};
            const std::string& scene = stage.scene("furnace", [&] { return furnace(f); });
            JobSpec job = stage.job(method, scene);
            job.resolution = {width, height};
            job.budget.iterations = 2;
            if (width == 1) {  // wide ones take long, and no layer knows its shape
              const auto offered = offered_layers(method.settings);
              job.layers.assign(offered.begin(), offered.end());
            }
            const auto pixels = done_image(stage.run(job, to_the_end), check);
            check.require(pixels.size() == 3 * std::size_t(width) * std::size_t(height),
                          "the file has another size");
            job.layers.clear();
            job.budget.iterations = width == 1 && height == 1 ? 256 : 4;
            check_furnace(stage.render(job), method, f, check);
          }};
}

/// Half has no number above 65504: refused where the picture is brighter, and only there.
Row bright(PixelType type) {
  return {fmt::format("radiance 1e6 as {}", enum_name(type)),
          [=](Stage& stage, const Method& method, Check& check) {
            const Furnace f{.albedo = 0, .radiance = 1e6};
            const std::string& scene = stage.scene("bright furnace", [&] { return furnace(f); });
            JobSpec job = stage.job(method, scene);
            const auto all = stage.render(job).film.mean();
            const bool too_bright = std::any_of(
                all.begin(), all.end(), [](double v) { return std::abs(v) > largest_half; });
            job.pixel_type = type;
            if (too_bright && type == PixelType::half_float) {
              check.refused([&] { stage.run(job, to_the_end); }, "half");
            } else {
              done_image(stage.run(job, to_the_end), check);
            }
          }};
}

}  // namespace

std::vector<Row> output_rows(const Effort& effort) {
  constexpr int longest = 16384;  // the schema's
  if (effort.quick) return {bright(PixelType::half_float), film(1, 1), film(longest, 1)};
  return {bright(PixelType::half_float), bright(PixelType::single_float), film(1, 1),
          film(longest, 1), film(1, longest)};
}

}  // namespace lacuna::extremes
