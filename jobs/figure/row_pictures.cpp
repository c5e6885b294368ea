#include "jobs/figure/row_pictures.h"

#include <algorithm>
#include <cmath>

#include "renderer/film/error_map.h"
#include "renderer/film/flip_colour.h"
#include "renderer/film/preview.h"

namespace lacuna {
namespace {

/// The overlap of an output pixel, `size` input pixels wide, with the input pixels [first, ...).
struct Coverage {
  int first;
  std::vector<double> shares;  ///< of sum 1
};
Coverage coverage(int pixel, double size, int inputs) {
  const double from = pixel * size, to = from + size;
  Coverage c{static_cast<int>(from), {}};
  for (int i = c.first; i < inputs && i < to; ++i) {
    c.shares.push_back((std::min<double>(to, i + 1) - std::max<double>(from, i)) / size);
  }
  return c;
}

/// A picture of floats with any number of channels.
struct Values {
  int width = 0, height = 0, channels = 3;
  std::vector<double> values;
};

/// The picture with at most `most_columns` columns, by averages over areas.
Values shrunk(const Values& in, double most_columns) {
  const int w = std::max(1, std::min(in.width, static_cast<int>(std::ceil(most_columns))));
  if (w == in.width) return in;
  const double size = double(in.width) / w;
  const int h = std::max(1, static_cast<int>(std::lround(in.height / size)));
  Values out{w, h, in.channels,
             std::vector<double>(static_cast<std::size_t>(w * h * in.channels), 0.0)};
  for (int y = 0; y < h; ++y) {
    const Coverage down = coverage(y, double(in.height) / h, in.height);
    for (int x = 0; x < w; ++x) {
      const Coverage across = coverage(x, size, in.width);
      double* to = out.values.data() + std::ptrdiff_t{y * w + x} * in.channels;
      for (std::size_t v = 0; v < down.shares.size(); ++v) {
        for (std::size_t u = 0; u < across.shares.size(); ++u) {
          const double* from =
              in.values.data() + ((std::ptrdiff_t{down.first} + std::ptrdiff_t(v)) * in.width +
                                  across.first + std::ptrdiff_t(u)) *
                                     in.channels;
          for (int c = 0; c < in.channels; ++c) {
            to[c] += down.shares[v] * across.shares[u] * from[c];
          }
        }
      }
    }
  }
  return out;
}

class ToneMapper {
 public:
  ToneMapper(ToneCurve curve, double stops) : curve_(curve), scale_(std::exp2(stops)) {}

  /// Shown values in [0, 1], linear.
  std::vector<double> shown(std::vector<double> rgb) const {
    for (double& v : rgb) {
      v = curve_ == ToneCurve::filmic ? double{flip_colour::aces(float(v * scale_))}
                                      : std::clamp(v * scale_, 0.0, 1.0);
    }
    return rgb;
  }
  CodeImage image(const std::vector<double>& rgb, int width, int height,
                  double most_columns) const {
    const Values small = shrunk({width, height, 3, shown(rgb)}, most_columns);
    CodeImage out{small.width, small.height, {}};
    for (const double v : small.values) out.rgb.push_back(display_code(v));
    return out;
  }

 private:
  ToneCurve curve_;
  double scale_;
};

/// Maps of one scale in false colours; empty where `maps` are.
std::vector<CodeImage> coloured(const std::vector<Values>& maps, double largest) {
  std::vector<CodeImage> images;
  for (const Values& map : maps) {
    const std::vector<float> values(map.values.begin(), map.values.end());
    images.push_back({map.width, map.height, magma_codes(values, largest)});
  }
  return images;
}

}  // namespace

RowPictures read_row(const FigureSource& source, std::size_t row, double page_width) {
  const FigureSpec& spec = source.spec();
  const FigureScene& scene = spec.scenes[row];
  const auto [width, height] = source.rows()[row].resolution;
  RowPictures out;
  for (const auto& [x, y, w, h] : scene.crops) out.crops.push_back({x, y, w, h});
  if (out.crops.empty()) out.crops.push_back({0, 0, width, height});
  const auto reference = source.reference(row);
  if (reference) out.reference_mse = reference->mse;
  const std::size_t columns = spec.methods.size() + (reference ? 1 : 0);
  out.shape = {{width, height},
               {out.crops[0].width, out.crops[0].height},
               out.crops.size(),
               columns,
               spec.error_map && reference};
  const RowLayout sizes = row_layout(out.shape, page_width, 0);

  std::optional<ToneMapper> tone;
  const auto show = [&](const std::vector<double>& rgb, const std::string& name) {
    if (!tone) {
      out.exposure = scene.exposure.value_or(std::log2(preview_exposure(rgb)));
      tone.emplace(spec.tone, out.exposure);
      out.whole = tone->image(rgb, width, height, sizes.whole_width);
      out.whole_of = name;
    }
    std::vector<CodeImage> details;
    for (const PixelRect& c : out.crops) {
      details.push_back(tone->image(cut(rgb, width, c), c.width, c.height, sizes.detail_width));
    }
    return details;
  };
  std::vector<CodeImage> of_reference;
  if (reference) of_reference = show(reference->rgb, "reference");
  std::vector<Values> maps;
  double largest = 0;
  for (std::size_t m = 0; m < spec.methods.size(); ++m) {
    const auto rgb = source.picture(row, m);
    out.details.push_back(rgb ? show(*rgb, spec.methods[m].name) : std::vector<CodeImage>{});
    if (!out.shape.mapped) continue;
    maps.emplace_back();
    if (!rgb) continue;
    const auto map = error_map(*spec.error_map, {*rgb, reference->rgb, width, height});
    largest = std::max(largest, largest_shown_error(*spec.error_map, map));
    maps.back() = shrunk({width, height, 1, {map.begin(), map.end()}}, sizes.detail_width);
  }
  if (largest > 0) out.largest_error = largest;
  out.error_maps = coloured(maps, out.largest_error);
  if (reference) out.details.push_back(std::move(of_reference));
  return out;
}

}  // namespace lacuna
