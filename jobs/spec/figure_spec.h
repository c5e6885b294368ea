#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/settings/field.h"
#include "jobs/spec/json_value.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {

/// The parts of a figure.
enum class FigurePanel { pictures, convergence, table };

template <>
struct EnumTable<FigurePanel> {
  static constexpr std::array<EnumValue<FigurePanel>, 3> values{{
      {FigurePanel::pictures, "pictures",
       "for each scene the whole picture, and for each method its crops, error and time"},
      {FigurePanel::convergence, "convergence",
       "error against time, log-log, with bands, the slope of Monte Carlo and the reference's "
       "noise"},
      {FigurePanel::table, "table", "scenes by methods: error, and time to equal error"},
  }};
};

/// How radiance becomes a displayed value.
enum class ToneCurve { srgb, filmic };

template <>
struct EnumTable<ToneCurve> {
  static constexpr std::array<EnumValue<ToneCurve>, 2> values{{
      {ToneCurve::srgb, "srgb", "clipped at 1, then the sRGB curve"},
      {ToneCurve::filmic, "filmic",
       "the approximation of ACES of Narkowicz (2016), then the sRGB curve"},
  }};
};

enum class FigureFont { sans, serif };

template <>
struct EnumTable<FigureFont> {
  static constexpr std::array<EnumValue<FigureFont>, 2> values{{
      {FigureFont::sans, "sans", "Linux Biolinum"},
      {FigureFont::serif, "serif", "Linux Libertine, the font of the ACM's papers"},
  }};
};

/// A column: the cells of a sweep that have these settings, or these jobs.
struct FigureMethod {
  std::string name;
  JsonTable<JsonValue> settings;
  std::vector<std::string> jobs;
  bool operator==(const FigureMethod&) const = default;
};
template <class V>
void describe(V& v, FigureMethod& s) {
  v("name", s.name, {.doc = "name in the figure", .min = 1, .max = 60, .required = true});
  v("settings", s.settings,
    {.doc = "values of swept settings, by pointer, that only the cells of this method have",
     .max = 16});
  v("jobs", s.jobs,
    {.doc =
         "instead of a sweep's cells: jobs, each by its folder, relative to this file, or by its "
         "id in the data folder; those of one picture differ in the seed alone",
     .max = 1000});
}

/// A row: a picture of the sweep, or of the jobs.
struct FigureScene {
  std::string name;
  JsonTable<JsonValue> settings;
  std::vector<std::array<int, 4>> crops;
  std::optional<double> exposure;
  bool operator==(const FigureScene&) const = default;
};
template <class V>
void describe(V& v, FigureScene& s) {
  v("name", s.name, {.doc = "name in the figure", .min = 1, .max = 60, .required = true});
  v("settings", s.settings,
    {.doc = "values of swept settings, or of any settings of jobs, by pointer; each picture all of "
            "whose cells have them is a row",
     .max = 16});
  v("crops", s.crops,
    {.doc = "details: x, y, width and height in pixels, from the upper left; all of one aspect "
            "ratio",
     .max = 4});
  v("exposure", s.exposure,
    {.doc = "exposure of all its pictures; none: that of the reference's preview",
     .min = -40,
     .max = 40,
     .unit = "stops"});
}

/// Size limit of a figure's file, in bytes.
inline constexpr std::size_t max_figure_bytes = 1 << 20;

/// The file of a figure.
struct FigureSpec {
  std::optional<std::string> sweep;
  std::vector<FigurePanel> show{FigurePanel::pictures, FigurePanel::convergence,
                                FigurePanel::table};
  std::vector<FigureScene> scenes;
  std::vector<FigureMethod> methods;
  std::vector<ErrorMetric> metrics;
  std::optional<ErrorMetric> error_map;
  std::optional<double> seconds, error;
  ToneCurve tone = ToneCurve::srgb;
  FigureFont font = FigureFont::sans;
  double width = 178;
  int dpi = 300;
  bool lossless = false;
  bool operator==(const FigureSpec&) const = default;
};
template <class V>
void describe(V& v, FigureSpec& s) {
  v("sweep", s.sweep,
    {.doc = "the folder of the sweep, relative to this file, or its id in the data folder; none: "
            "the methods name jobs",
     .min = 1});
  v("show", s.show, {.doc = "the parts, from top to bottom", .min = 1, .max = 3});
  v("scenes", s.scenes, {.doc = "the rows", .min = 1, .max = 12, .required = true});
  v("methods", s.methods, {.doc = "the columns", .min = 1, .max = 8, .required = true});
  v("metrics", s.metrics,
    {.doc = "errors below the crops and in tables; the first is also that of the curves and of "
            "the time to equal error; none: the sweep's metric",
     .max = 4});
  v("error_map", s.error_map,
    {.doc = "whole pictures of the errors in false colours, by this metric; none: no such row"});
  v("seconds", s.seconds,
    {.doc = "render time at which errors are compared; none: the last that all methods reach",
     .min = 0,
     .above_min = true,
     .unit = "s"});
  v("error", s.error,
    {.doc = "error of the first metric for which times are compared; none: the smallest that all "
            "methods reach",
     .min = 0,
     .above_min = true});
  v("tone", s.tone, {.doc = "how radiance times the exposure becomes a displayed value"});
  v("font", s.font, {.doc = "font of all text"});
  v("width", s.width,
    {.doc = "width of the figure: 178 is two columns of the ACM's papers, 85 one",
     .min = 60,
     .max = 600,
     .unit = "mm"});
  v("dpi", s.dpi,
    {.doc = "resolution of a PNG, and the highest of the pictures in a PDF or SVG",
     .min = 50,
     .max = 1200});
  v("lossless", s.lossless,
    {.doc =
         "true: all pixels of a PDF or SVG are exact; false: pictures of more than 96 x 96 pixels "
         "are JPEGs of quality 95, without subsampling"});
}

}  // namespace lacuna
