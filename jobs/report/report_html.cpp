#include "jobs/report/report_html.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "jobs/report/page_files.h"
#include "jobs/spec/page_tables.h"
#include "jobs/spec/version.h"
#include "jobs/store/job_folder.h"

namespace lacuna {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string png_address(const std::string& png) { return "data:image/png;base64," + base64(png); }

OrderedJson to_json(const PictureCrops& crops) {
  OrderedJson cells = OrderedJson::array();
  for (const CellCrop& c : crops.cells) {
    cells.push_back({{"cell", c.cell + 1}, {"seconds", c.seconds}, {"src", png_address(c.png)}});
  }
  return {{"picture", crops.picture + 1},
          {"rectangle", {crops.x, crops.y, crops.width, crops.height}},
          {"reference", crops.reference_png ? OrderedJson(png_address(*crops.reference_png))
                                            : OrderedJson(nullptr)},
          {"cells", std::move(cells)}};
}

/// JSON that is safe in a script element: no "</script>", no "<!--".
std::string in_script(const OrderedJson& json) {
  std::string text;
  for (const char c : json_text(json)) text += c == '<' ? "\\u003c" : std::string(1, c);
  return text;
}

std::string in_markup(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return safe;
}

}  // namespace

std::string report_html(const SweepFolder& sweep, const Answers& answers,
                        const SweepPictures& pictures) {
  OrderedJson data{{"answers", parse_own(answers_text(sweep, answers))}};
  data["crops"] = OrderedJson::array();
  for (const PictureCrops& c : pictures.crops) data["crops"].push_back(to_json(c));
  data["version"] = version();
  data["made"] = utc_now();
  const std::string title = sweep.spec().label.empty() ? "Sweep" : sweep.spec().label;
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{} · Lacuna</title>\n"
      "<style>\n{}</style>\n</head>\n<body>\n<main id=\"main\"></main>\n"
      "<script type=\"application/json\" id=\"data\">{}</script>\n"
      "<script>\nconst module_job_tables = {};\n{}</script>\n"
      "</body>\n</html>\n",
      in_markup(title), report_style, in_script(data), in_script(page_tables()), report_script);
}

}  // namespace lacuna
