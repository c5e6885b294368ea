#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace lacuna {

// A figure as a list of marks in points (1/72 inch), from the upper left, y down. What the figure
// shows is decided before any file format is, and tests can read it.

struct Ink {
  double r = 0, g = 0, b = 0, alpha = 1;
  bool operator==(const Ink&) const = default;
};

struct FigurePoint {
  double x = 0, y = 0;
};

/// Pixels as sRGB codes, three for each, top row first.
struct CodeImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

struct TextStyle {
  double size = 7;
  bool bold = false;
  Ink ink = {};
};

/// One line of text on the base line y. `anchor`: the share of its width that lies left of x.
struct TextMark {
  double x = 0, y = 0;
  std::string text;
  TextStyle style;
  double anchor = 0;
  bool upwards = false;  ///< turned by 90 degrees, from bottom to top
};

struct LineMark {
  std::vector<FigurePoint> points;
  double width = 0.5;
  Ink ink = {};
  std::vector<double> dashes = {};
};

struct AreaMark {
  std::vector<FigurePoint> corners;
  Ink ink;
};

/// `frame` of width 0: none.
struct ImageMark {
  double x = 0, y = 0, width = 0, height = 0;
  CodeImage image;
  double frame = 0;
  Ink frame_ink = {};
};

inline constexpr int jpeg_pixels = 96 * 96;

struct Drawing {
  double width = 0, height = 0;
  std::string title;
  std::string font;  ///< family, as fontconfig knows it
  /// Quality of the JPEGs that pictures of more than `jpeg_pixels` are in a PDF or SVG; 0: none
  /// are.
  int jpeg_quality = 0;
  std::vector<std::variant<TextMark, LineMark, AreaMark, ImageMark>> marks;

  template <class Mark>
  void add(Mark mark) {
    marks.emplace_back(std::move(mark));
  }
};

}  // namespace lacuna
