#include "jobs/figure/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/json/json_text.h"
#include "jobs/figure/row_pictures.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {
namespace {

constexpr std::size_t most_methods = 8, most_scenes = 12;

/// "Cornell ball", of cornell_ball.glb.
std::string scene_name(const JobSpec& job) {
  std::string name = std::filesystem::path(job.scene).stem().string();
  std::replace(name.begin(), name.end(), '_', ' ');
  if (name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

/// Adds the settings of scenes of one name to their names.
void tell_apart(std::vector<FigureScene>& scenes) {
  std::map<std::string, int> same;
  for (const FigureScene& s : scenes) ++same[s.name];
  for (FigureScene& s : scenes) {
    if (same[s.name] < 2) continue;
    JsonTable<JsonValue> others = s.settings;
    others.erase("/scene");
    s.name = fmt::format("{}, {}", s.name, cell_text(others)).substr(0, 60);
  }
}

class Suggestion {
 public:
  Suggestion(const std::filesystem::path& sweep, const std::string& name) : sweep_(sweep) {
    spec_.sweep = name;
  }

  FigureSpec run() {
    const Answers answers = answer(sweep_);
    for (const PictureAnswer& p : answers.pictures) {
      for (std::string& pointer : settings_that_vary(sweep_.plan(), p.cells).vary) {
        of_methods_.insert(std::move(pointer));
      }
    }
    for (std::size_t p = 0; p < answers.pictures.size() && spec_.scenes.size() < most_scenes; ++p) {
      add_scene(answers.pictures[p], answers);
    }
    if (spec_.scenes.empty()) {
      throw BadJob({{"", fmt::format("{}: no run is done", sweep_.dir().string())}});
    }
    tell_apart(spec_.scenes);
    FigureSpec found = spec_;
    found.sweep = sweep_.dir().string();
    const FigureSource source(found, "");
    bool referenced = true;
    for (std::size_t r = 0; r < spec_.scenes.size(); ++r)
      referenced = add_crops(source, r) && referenced;
    if (referenced) {
      spec_.metrics = {source.metrics().front()};
      if (spec_.metrics.front() != ErrorMetric::flip) spec_.metrics.push_back(ErrorMetric::flip);
      spec_.error_map = ErrorMetric::flip;
    }
    return spec_;
  }

 private:
  void add_scene(const PictureAnswer& picture, const Answers& answers) {
    const SweepPlan& plan = sweep_.plan();
    const bool any = std::any_of(picture.cells.begin(), picture.cells.end(),
                                 [&](std::size_t c) { return !answers.cells[c].done.empty(); });
    if (!any) return;
    FigureScene scene;
    scene.settings = settings_that_vary(plan, picture.cells).shared;
    for (const std::string& pointer : of_methods_) scene.settings.erase(pointer);
    scene.name = scene_name(plan.cells[picture.cells.front()].job);
    spec_.scenes.push_back(std::move(scene));
    for (const std::size_t c : picture.cells) {
      FigureMethod method;
      for (const std::string& pointer : of_methods_) {
        method.settings[pointer] = plan.cells[c].settings.at(pointer);
      }
      add_method(std::move(method));
    }
  }

  void add_method(FigureMethod method) {
    const bool known = std::any_of(spec_.methods.begin(), spec_.methods.end(),
                                   [&](const auto& m) { return m.settings == method.settings; });
    if (known || spec_.methods.size() == most_methods) return;
    // The value alone where one setting tells the methods apart.
    if (method.settings.size() == 1) {
      const OrderedJson value = parse_own(method.settings.begin()->second.text);
      if (value.is_string()) method.name = value.get<std::string>();
    }
    if (method.name.empty()) method.name = cell_text(method.settings);
    if (method.name.empty()) method.name = "the job";
    if (method.name.size() > 60) method.name.resize(60);
    spec_.methods.push_back(std::move(method));
  }

  /// False: the scene has no reference.
  bool add_crops(const FigureSource& source, std::size_t row) {
    const auto [width, height] = source.rows()[row].resolution;
    const int side = std::max(std::min({width, height, 16}), std::min(width, height) / 4);
    const std::vector<PixelRect> grid = crop_grid(width, height, side, side);
    const RowReader read{source, row};
    const auto reference = read.reference();
    std::vector<std::vector<double>> errors;  // of each method, by crop
    std::vector<double> first;
    for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
      const auto picture = read.picture(m);
      if (!picture) continue;
      const std::vector<double>& other = reference ? *reference : first;
      if (other.empty()) {
        first = *picture;
        continue;
      }
      auto& own = errors.emplace_back();
      for (const PixelRect& c : grid) {
        own.push_back(relative_error(cut(*picture, width, c), cut(other, width, c)));
      }
    }
    choose(grid, errors, spec_.scenes[row].crops);
    return reference.has_value();
  }

  static double relative_error(const std::vector<double>& x, const std::vector<double>& r) {
    // The median of the pixels' terms would miss fireflies, the mean sees little else: a mean of
    // roots lies between.
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum += std::sqrt(row_of(ErrorMetric::relmse).term(x[i], r[i]));
    }
    return sum / static_cast<double>(x.size());
  }

  /// Two rectangles without common pixels in which the methods' errors differ most.
  static void choose(const std::vector<PixelRect>& grid,
                     const std::vector<std::vector<double>>& errors,
                     std::vector<std::array<int, 4>>& crops) {
    if (errors.empty()) return;
    std::vector<std::size_t> order(grid.size());
    std::vector<double> spread;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      order[i] = i;
      double low = errors[0][i], high = errors[0][i];
      for (const auto& e : errors) {
        low = std::min(low, e[i]);
        high = std::max(high, e[i]);
      }
      spread.push_back(errors.size() > 1 ? high - low : high);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return spread[a] > spread[b]; });
    for (const std::size_t i : order) {
      const PixelRect& c = grid[i];
      const bool apart = std::all_of(crops.begin(), crops.end(), [&](const auto& k) {
        return std::abs(k[0] - c.x) >= c.width || std::abs(k[1] - c.y) >= c.height;
      });
      if (apart) crops.push_back({c.x, c.y, c.width, c.height});
      if (crops.size() == 2) return;
    }
  }

  SweepFolder sweep_;
  std::set<std::string> of_methods_;  // pointers that vary among the cells of some picture
  FigureSpec spec_;
};

}  // namespace

FigureSpec suggest_figure(const std::filesystem::path& sweep, const std::string& name) {
  return Suggestion(sweep, name).run();
}

}  // namespace lacuna
