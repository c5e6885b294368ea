#include "jobs/figure/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/json/json_text.h"
#include "jobs/figure/figure_source.h"
#include "jobs/report/crop_selection.h"

namespace lacuna {
namespace {

constexpr std::size_t most_methods = 8, most_scenes = 12;

/// The first 60 characters of a name (UTF-8), as many as a figure's file allows.
std::string shortened(const std::string& name) {
  std::size_t end = 0;
  for (int characters = 0; end < name.size(); ++end) {
    if ((name[end] & 0xC0) != 0x80 && ++characters > 60) break;  // a character begins
  }
  return name.substr(0, end);
}

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
    s.name = shortened(fmt::format("{}, {}", s.name, cell_text(others)));
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
    name_methods();
    FigureSpec found = spec_;
    found.sweep = sweep_.dir().string();
    const FigureSource source(found, "");
    if (source.rows().size() != spec_.scenes.size()) {
      throw BadJob({{"", fmt::format("{}: some of its pictures do not differ in their settings",
                                     sweep_.dir().string())}});
    }
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
    scene.name = shortened(scene_name(plan.cells[picture.cells.front()].job));
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
    spec_.methods.push_back(std::move(method));
  }

  /// The settings of a method, of objects only the keys whose values differ among the methods.
  JsonTable<JsonValue> own_settings(const FigureMethod& method) const {
    JsonTable<JsonValue> own = method.settings;
    for (auto& [pointer, value] : own) {
      OrderedJson object = parse_own(value.text);
      if (!object.is_object()) continue;
      const auto is_common = [&](const std::string& key) {
        return key != "type" && key != "name" &&
               std::ranges::all_of(spec_.methods, [&](const FigureMethod& m) {
                 const OrderedJson other = parse_own(m.settings.at(pointer).text);
                 return other.is_object() && other.value(key, OrderedJson()) == object.at(key);
               });
      };
      std::vector<std::string> common;
      for (const auto& item : object.items()) {
        if (is_common(item.key())) common.push_back(item.key());
      }
      for (const std::string& key : common) object.erase(key);
      value.text = json_text(object);
    }
    return own;
  }

  void name_methods() {
    for (FigureMethod& method : spec_.methods) {
      method.name = cell_text(own_settings(method));
      // The value alone where the methods differ in one setting, and it is no number.
      const char first =
          method.settings.size() == 1 ? method.settings.begin()->second.text[0] : ' ';
      if (first == '"' || first == '{') method.name.erase(0, method.name.find(' ') + 1);
      method.name = method.name.empty() ? "the job" : shortened(method.name);
    }
  }

  /// False: the scene has no reference.
  bool add_crops(const FigureSource& source, std::size_t row) {
    const auto [width, height] = source.rows()[row].resolution;
    const int side = std::max(std::min({width, height, 16}), std::min(width, height) / 4);
    CropSelection crops({width, height}, side);
    const auto reference = source.reference(row);
    for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
      const auto picture = source.picture(row, m);
      if (picture) crops.add(*picture, reference ? reference->rgb : std::vector<double>());
    }
    for (const PixelRect& c : crops.choose(2)) {
      spec_.scenes[row].crops.push_back({c.x, c.y, c.width, c.height});
    }
    return reference.has_value();
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
