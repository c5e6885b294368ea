#include "jobs/figure/surface.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "jobs/figure/jpeg_write.h"

namespace lacuna {
namespace {

struct CairoDeleter {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
  void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, CairoDeleter>;
using Context = std::unique_ptr<cairo_t, CairoDeleter>;

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw std::runtime_error(
      fmt::format("the figure was not drawn: {}", cairo_status_to_string(status)));
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int n) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), n);
  return CAIRO_STATUS_SUCCESS;
}

void set_ink(cairo_t* c, const Ink& ink) {
  cairo_set_source_rgba(c, ink.r, ink.g, ink.b, ink.alpha);
}

void set_font(cairo_t* c, const std::string& font, const TextStyle& style) {
  cairo_select_font_face(c, font.c_str(), CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, style.size);
  cairo_font_options_t* options = cairo_font_options_create();
  // Widths that do not depend on the resolution.
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(c, options);
  cairo_font_options_destroy(options);
}

double advance(cairo_t* c, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(c, text.c_str(), &extents);
  return extents.x_advance;
}

class Painter {
 public:
  Painter(cairo_t* c, const Drawing& drawing)
      : c_(c), font_(drawing.font), quality_(drawing.jpeg_quality) {}

  void operator()(const TextMark& t) const {
    set_font(c_, font_, t.style);
    set_ink(c_, t.style.ink);
    cairo_save(c_);
    cairo_translate(c_, t.x, t.y);
    if (t.upwards) cairo_rotate(c_, -std::numbers::pi / 2);
    cairo_move_to(c_, -t.anchor * advance(c_, t.text), 0);
    cairo_show_text(c_, t.text.c_str());
    cairo_restore(c_);
  }

  void operator()(const LineMark& line) const {
    trace(line.points);
    set_ink(c_, line.ink);
    cairo_set_line_width(c_, line.width);
    cairo_set_line_join(c_, CAIRO_LINE_JOIN_ROUND);
    cairo_set_dash(c_, line.dashes.data(), static_cast<int>(line.dashes.size()), 0);
    cairo_stroke(c_);
    cairo_set_dash(c_, nullptr, 0, 0);
  }

  void operator()(const AreaMark& area) const {
    trace(area.corners);
    cairo_close_path(c_);
    set_ink(c_, area.ink);
    cairo_fill(c_);
  }

  void operator()(const ImageMark& m) const {
    const int w = m.image.width, h = m.image.height;
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, w, h));
    check(cairo_surface_status(surface.get()));
    unsigned char* pixels = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < h; ++y) {
      auto* row = reinterpret_cast<std::uint32_t*>(pixels + std::ptrdiff_t{y} * stride);
      const std::uint8_t* from = m.image.rgb.data() + 3 * std::ptrdiff_t{y} * w;
      for (int x = 0; x < w; ++x, from += 3) {
        row[x] = std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | from[2];
      }
    }
    cairo_surface_mark_dirty(surface.get());
    if (quality_ > 0 && w * h > jpeg_pixels) attach_jpeg(surface.get(), m.image);
    cairo_save(c_);
    cairo_translate(c_, m.x, m.y);
    cairo_scale(c_, m.width / w, m.height / h);
    cairo_set_source_surface(c_, surface.get(), 0, 0);
    // Enlarged pixels stay squares.
    cairo_pattern_set_filter(cairo_get_source(c_), CAIRO_FILTER_NEAREST);
    cairo_rectangle(c_, 0, 0, w, h);
    cairo_fill(c_);
    cairo_restore(c_);
    if (m.frame <= 0) return;
    cairo_rectangle(c_, m.x, m.y, m.width, m.height);
    set_ink(c_, m.frame_ink);
    cairo_set_line_width(c_, m.frame);
    cairo_set_line_join(c_, CAIRO_LINE_JOIN_MITER);
    cairo_stroke(c_);
  }

 private:
  /// What a PDF or SVG stores instead of the pixels.
  void attach_jpeg(cairo_surface_t* surface, const CodeImage& image) const {
    auto bytes = std::make_unique<std::string>(encode_jpeg(image, quality_));
    const auto* data = reinterpret_cast<const unsigned char*>(bytes->data());
    check(cairo_surface_set_mime_data(
        surface, CAIRO_MIME_TYPE_JPEG, data, bytes->size(),
        [](void* text) { delete static_cast<std::string*>(text); }, bytes.get()));
    bytes.release();  // NOLINT(bugprone-unused-return-value): the surface deletes it
  }

  void trace(const std::vector<FigurePoint>& points) const {
    cairo_new_path(c_);
    for (const FigurePoint& p : points) cairo_line_to(c_, p.x, p.y);
  }

  cairo_t* c_;
  const std::string& font_;
  int quality_;
};

void paint(cairo_surface_t* surface, const Drawing& drawing, double scale) {
  check(cairo_surface_status(surface));
  const Context context(cairo_create(surface));
  cairo_scale(context.get(), scale, scale);
  const Painter painter(context.get(), drawing);
  for (const auto& mark : drawing.marks) std::visit(painter, mark);
  check(cairo_status(context.get()));
}

/// Paints a file that is written while it is painted.
void paint_stream(cairo_surface_t* surface, const Drawing& drawing) {
  paint(surface, drawing, 1);
  cairo_surface_finish(surface);
  check(cairo_surface_status(surface));
}

}  // namespace

double text_width(const std::string& font, const TextStyle& style, std::string_view text) {
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  const Context context(cairo_create(surface.get()));
  set_font(context.get(), font, style);
  return advance(context.get(), std::string(text));
}

std::string draw_pdf(const Drawing& drawing) {
  std::string bytes;
  const Surface surface(
      cairo_pdf_surface_create_for_stream(append, &bytes, drawing.width, drawing.height));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, drawing.title.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "Lacuna");
  paint_stream(surface.get(), drawing);
  return bytes;
}

std::string draw_svg(const Drawing& drawing) {
  std::string bytes;
  const Surface surface(
      cairo_svg_surface_create_for_stream(append, &bytes, drawing.width, drawing.height));
  paint_stream(surface.get(), drawing);
  return bytes;
}

std::string draw_png(const Drawing& drawing, int dpi) {
  const double scale = dpi / 72.0;
  const Surface surface(cairo_image_surface_create(
      CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(drawing.width * scale)),
      static_cast<int>(std::ceil(drawing.height * scale))));
  check(cairo_surface_status(surface.get()));
  {
    const Context white(cairo_create(surface.get()));
    set_ink(white.get(), {1, 1, 1, 1});
    cairo_paint(white.get());
  }
  paint(surface.get(), drawing, scale);
  std::string bytes;
  check(cairo_surface_write_to_png_stream(surface.get(), append, &bytes));
  return bytes;
}

}  // namespace lacuna
