#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/run/results.h"
#include "jobs/store/inputs.h"
#include "jobs/sweep/estimate.h"
#include "renderer/film/block_statistics.h"
#include "renderer/film/crop.h"
#include "renderer/film/display_errors.h"
#include "renderer/film/error_map.h"
#include "renderer/film/metrics.h"
#include "renderer/film/preview.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/images/exr_write.h"
#include "renderer/images/image_read.h"
#include "renderer/images/png_write.h"

namespace lacuna {

namespace {

struct CompareOptions {
  std::filesystem::path a, b;
  int block = 0;
  std::vector<int> crop;  ///< x, y, width, height; empty: the whole picture
  std::filesystem::path map;
  ErrorMetric metric = ErrorMetric::flip;  ///< of the map
};

/// Throws SceneError if the requested rectangle is not inside the picture.
PixelRect crop_of(const CompareOptions& o, const FloatImage& image) {
  if (o.crop.empty()) return {0, 0, image.width, image.height};
  const PixelRect c{o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
  if (!is_inside(c, image.width, image.height)) {
    throw SceneError(fmt::format("--crop {} {} {} {} is not inside the pictures, {} x {}", c.x, c.y,
                                 c.width, c.height, image.width, image.height));
  }
  return c;
}

/// The rectangle's values, three per pixel. Throws SceneError, with `label`, if one is not finite.
std::vector<double> in_double(const FloatImage& image, const PixelRect& crop,
                              const std::string& label) {
  const FloatImage part{crop.width, crop.height, cut(image.rgb, image.width, crop), {}};
  require_finite(part, label);
  return {part.rgb.begin(), part.rgb.end()};
}

/// Variance of a - b, from the known layers; empty: A has no such layer.
std::vector<double> variance_of_difference(const CompareOptions& o, const PixelRect& crop) {
  std::vector<double> sum;
  for (const auto& file : {o.a, o.b}) {
    FloatImage layer;
    try {
      layer = read_float_image(file, "variance");
    } catch (const SceneError&) {
      if (file == o.a) return {};
      continue;
    }
    const auto found = layer.attributes.find(fmt::format("lacuna:{}", variance_scale_attribute));
    const double scale = found == layer.attributes.end() ? 1 : std::stod(found->second);
    const std::vector<double> v = in_double(layer, crop, file.string() + ": layer variance");
    if (sum.empty()) sum.resize(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) sum[i] += v[i] / scale;
  }
  return sum;
}

void print_blocks(const CompareOptions& o, const PixelRect& crop, const std::vector<double>& a,
                  const std::vector<double>& b) {
  if (o.block > std::min(crop.width, crop.height)) {
    throw SceneError(fmt::format("--block {} is larger than the compared area, {} x {}", o.block,
                                 crop.width, crop.height));
  }
  const std::vector<double> variance = variance_of_difference(o, crop);
  const BlockStatistics s = block_statistics({a, b, variance, crop.width, crop.height}, o.block);
  fmt::print(
      "blocks  {} of {} x {} pixels\nblock_rms {:.9g}\nblock_relative {:.6g}\nworst_block {}, {}\n",
      s.blocks, o.block, o.block, s.rms, s.largest_relative, crop.x + s.worst_x,
      crop.y + s.worst_y);
  if (variance.empty()) return;
  fmt::print("z_mean {:.4f}\nz_deviation {:.4f}\nz_beyond_1.96 {:.4f}\n", s.z_mean, s.z_deviation,
             s.z_beyond);
}

/// Writes the error of each pixel: values as an EXR, else colours as a PNG.
void write_map(const CompareOptions& o, const FlipPictures& pictures, const ThreadPool& pool) {
  const std::vector<float> map = error_map(o.metric, pictures, &pool);
  const double largest = largest_shown_error(o.metric, map);
  if (o.map.extension() == ".exr") {
    ExrPicture picture{pictures.width, pictures.height, {}, PixelType::single_float, {}};
    picture.layers.push_back({"", {"Y"}, {map.begin(), map.end()}});
    picture.attributes["metric"] = enum_name(o.metric);
    write_exr(o.map, picture);
  } else {
    write_file_atomically(o.map,
                          encode_png(pictures.width, pictures.height, magma_codes(map, largest)));
    fmt::print("map_largest {:.6g}\n", largest);
  }
}

/// The picture at a path, which may be a job's folder.
std::filesystem::path picture_of(const std::filesystem::path& named) {
  return std::filesystem::is_directory(named) ? named / "image.exr" : named;
}

/// The input files of a picture in a job's folder, except the reference; empty: unknown.
InputList inputs_of(const std::filesystem::path& picture) {
  InputList inputs = read_inputs(JobFolder(picture.parent_path())).value_or(InputList{});
  std::erase_if(inputs, [](const InputFile& file) { return file.role == InputRole::reference; });
  return inputs;
}

/// Pictures of different scenes may be compared on purpose.
void warn_of_other_scenes(const CompareOptions& o, const FloatImage& a, const FloatImage& b) {
  const InputList of_a = inputs_of(o.a), of_b = inputs_of(o.b);
  std::vector<std::string> differences = changed_inputs(of_b, of_a);
  if (!of_a.empty() && !of_b.empty()) {
    const std::string scene_a = input_text(of_a.front()), scene_b = input_text(of_b.front());
    if (scene_a != scene_b) differences.push_back(scene_a + " in place of " + scene_b);
  } else {
    const auto hash = [](const FloatImage& image) {
      const auto found = image.attributes.find("lacuna:scene_hash");
      return found == image.attributes.end() ? "" : found->second;
    };
    const std::string hash_a = hash(a), hash_b = hash(b);
    if (!hash_a.empty() && !hash_b.empty() && hash_a != hash_b) {
      differences.push_back(fmt::format("a scene of hash {} in place of {}", hash_a, hash_b));
    }
  }
  if (differences.empty()) return;
  fmt::print(stderr, "warning: {} was made from other files than {}: {}\n", o.a.string(),
             o.b.string(), fmt::join(differences, "; "));
}

void compare(CompareOptions o) {
  o.a = picture_of(o.a);
  o.b = picture_of(o.b);
  const FloatImage image_a = read_reference_image(o.a);
  const FloatImage image_b = read_reference_image(o.b);
  if (image_a.width != image_b.width || image_a.height != image_b.height) {
    throw SceneError(fmt::format("{} has {} x {} pixels, {} {} x {}", o.a.string(), image_a.width,
                                 image_a.height, o.b.string(), image_b.width, image_b.height));
  }
  warn_of_other_scenes(o, image_a, image_b);
  const PixelRect crop = crop_of(o, image_a);
  const std::string where = o.crop.empty() ? "" : ", in the crop";
  const std::vector<double> a = in_double(image_a, crop, o.a.string() + where);
  const std::vector<double> b = in_double(image_b, crop, o.b.string() + where);
  const Errors e = errors(a, b);
  for (const ErrorMetricRow& metric : error_metrics) {
    if (metric.term == nullptr) continue;
    fmt::print("{:<7} {:.9g}\n", metric.name, e[metric.value]);
  }
  const FlipPictures both{a, b, crop.width, crop.height};
  const FlipExposures exposures = flip_exposures(b);
  const ThreadPool pool(0);
  fmt::print("{:<7} {:.9g}\nflip_exposures {:.4f} to {:.4f}, {}\n", enum_name(ErrorMetric::flip),
             flip_mean(hdr_flip(both, exposures, &pool)), exposures.start, exposures.stop,
             exposures.count);
  const double mean_a = mean(a).value, mean_b = mean(b).value;
  fmt::print("mean_a  {:.9g}\nmean_b  {:.9g}\nmean_relative {:.6g}\n", mean_a, mean_b,
             (mean_a - mean_b) / mean_b);
  const double exposure = preview_exposure(b);
  const DisplayErrors d = display_errors(a, b, crop.width, crop.height, exposure);
  fmt::print("exposure {:.6g}\ndisplay_mse {:.6g}\npsnr {:.6g}\nssim {:.6g}\ndisplay_flip {:.6g}\n",
             exposure, d.mse, d.psnr, d.ssim, flip_mean(ldr_flip(both, exposure, &pool)));
  if (o.block > 0) print_blocks(o, crop, a, b);
  if (!o.map.empty()) write_map(o, both, pool);
}

}  // namespace

void add_compare(CLI::App& app, int& code) {
  const auto o = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand(
      "compare",
      "Print all errors of one EXR against another, and their means; display_mse, "
      "psnr and ssim compare sRGB values of 0 to 255, and display_flip (LDR-FLIP) displayed "
      "values, at the exposure of B's preview; flip is HDR-FLIP over flip_exposures");
  command->add_option("A", o->a, "the estimate: an EXR, or a job's folder")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("B", o->b, "the reference, likewise")->required()->check(CLI::ExistingPath);
  command
      ->add_option("--block", o->block,
                   "also compare the means of square blocks with sides of this many pixels; with a "
                   "layer \"variance\" in A (and in B), also as z-scores")
      ->check(CLI::Range(1, 16384));
  command
      ->add_option("--crop", o->crop, "compare only this rectangle, in pixels from the upper left")
      ->type_name("X Y WIDTH HEIGHT")
      ->expected(4);
  const auto suffix = [](const std::string& file) -> std::string {
    const auto end = std::filesystem::path(file).extension();
    return end == ".png" || end == ".exr" ? "" : fmt::format("\"{}\" is no .png or .exr", file);
  };
  CLI::Option* map = command
                         ->add_option("--map", o->map,
                                      "write the error of each pixel: values (.exr), or colours "
                                      "from black, 0, to yellow, map_largest (.png)")
                         ->check(CLI::Validator(suffix, "FILE.png or .exr"));
  std::map<std::string, ErrorMetric> metrics;
  for (const ErrorMetricRow& m : error_metrics) {
    if (needs_reference(m.value)) metrics.emplace(m.name, m.value);
  }
  command->add_option("--metric", o->metric, "the error of the map (default: flip)")
      ->transform(CLI::CheckedTransformer(metrics))
      ->option_text("NAME")
      ->needs(map);
  command->callback([o, &code] {
    compare(*o);
    code = exit_done;
  });
}

}  // namespace lacuna
