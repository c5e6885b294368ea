#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "jobs/cli/commands.h"
#include "renderer/film/block_statistics.h"
#include "renderer/film/metrics.h"
#include "renderer/scene/image_read.h"
#include "renderer/scene/scene_data.h"

namespace lacuna {

namespace {

struct Options {
  std::filesystem::path a, b;
  int block = 0;
};

std::vector<double> in_double(const FloatImage& image) {
  return {image.rgb.begin(), image.rgb.end()};
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// Variance of a - b as far as it is known; empty: A has no such layer.
std::vector<double> variance_of_difference(const Options& o) {
  std::vector<double> sum;
  for (const auto& file : {o.a, o.b}) {
    try {
      const std::vector<double> v = in_double(read_float_image(file, "variance"));
      if (sum.empty()) sum.resize(v.size());
      for (std::size_t i = 0; i < v.size(); ++i) sum[i] += v[i];
    } catch (const SceneError&) {
      if (file == o.a) return {};
    }
  }
  return sum;
}

void print_blocks(const Options& o, const FloatImage& image, const std::vector<double>& a,
                  const std::vector<double>& b) {
  if (o.block > std::min(image.width, image.height)) {
    throw SceneError(fmt::format("--block {} is larger than the pictures, {} x {}", o.block,
                                 image.width, image.height));
  }
  const std::vector<double> variance = variance_of_difference(o);
  const BlockStatistics s = block_statistics(a, b, variance, image.width, image.height, o.block);
  fmt::print("blocks  {} of {} x {} pixels\nblock_relative {:.6g}\nworst_block {}, {}\n", s.blocks,
             o.block, o.block, s.largest_relative, s.worst_x, s.worst_y);
  if (variance.empty()) return;
  fmt::print("z_mean {:.4f}\nz_deviation {:.4f}\nz_beyond_1.96 {:.4f}\n", s.z_mean, s.z_deviation,
             s.z_beyond);
}

void compare(const Options& o) {
  const FloatImage image_a = read_float_image(o.a);
  const FloatImage image_b = read_float_image(o.b);
  if (image_a.width != image_b.width || image_a.height != image_b.height) {
    throw SceneError(fmt::format("{} has {} x {} pixels, {} {} x {}", o.a.string(), image_a.width,
                                 image_a.height, o.b.string(), image_b.width, image_b.height));
  }
  const std::vector<double> a = in_double(image_a);
  const std::vector<double> b = in_double(image_b);
  const Errors e = errors(a, b);
  for (const auto& metric : EnumTable<ErrorMetric>::values) {
    if (metric.value == ErrorMetric::est_rmse) continue;
    fmt::print("{:<7} {:.9g}\n", metric.name, value_of(e, metric.value));
  }
  fmt::print("mean_a  {:.9g}\nmean_b  {:.9g}\nmean_relative {:.6g}\n", mean(a), mean(b),
             (mean(a) - mean(b)) / mean(b));
  if (o.block > 0) print_blocks(o, image_a, a, b);
}

}  // namespace

void add_compare(CLI::App& app, int& code) {
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "compare", "Print every error of one EXR against another, and their means");
  command->add_option("A", o->a, "the estimate")->required()->check(CLI::ExistingFile);
  command->add_option("B", o->b, "the reference")->required()->check(CLI::ExistingFile);
  command
      ->add_option("--block", o->block,
                   "compare the means of square blocks of this many pixels too; with the layer "
                   "\"variance\" in A (and in B), also as z-scores")
      ->check(CLI::Range(1, 16384));
  command->callback([o, &code] {
    compare(*o);
    code = exit_done;
  });
}

}  // namespace lacuna
