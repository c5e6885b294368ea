#include "jobs/import/mitsuba/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/json/json_cursor.h"

namespace lacuna::mitsuba {
namespace {

constexpr std::string_view separators = " \t\r\n,";

/// A number with what may stand behind it ("50mm", "5000K").
double leading_number(const SceneElement& at, std::string_view text, std::string_view unit) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  const std::string_view rest(read.ptr, static_cast<std::size_t>(end - read.ptr));
  if (read.ec == std::errc::invalid_argument || !(rest.empty() || rest == unit)) {
    at.fail(fmt::format("has {}; allowed: a number", in_quotes(text)));
  }
  if (!std::isfinite(value) || std::abs(value) > 1e30) {
    at.fail(fmt::format("has {}; allowed: numbers up to 1e30", in_quotes(text)));
  }
  return value;
}

}  // namespace

SceneIds::SceneIds(const SceneElement& root) { enter(root); }

void SceneIds::enter(const SceneElement& e) {
  if (e.tag == "alias") {
    const auto found = elements_.find(e.attribute("id"));
    if (found == elements_.end()) {
      e.fail(fmt::format("names {}, which no element before it has as its id",
                         in_quotes(e.attribute("id"))));
    }
    elements_[e.attribute("as")] = found->second;
    e.read = true;
  } else if (e.tag != "ref" && e.has("id")) {
    if (!elements_.emplace(e.attribute("id"), &e).second) {
      e.fail("has an id that another element has, too");
    }
  }
  for (const SceneElement& child : e.children) enter(child);
}

const SceneElement& SceneIds::resolve(const SceneElement& e) const {
  if (e.tag != "ref") return e;
  const auto found = elements_.find(e.attribute("id"));
  if (found == elements_.end()) {
    e.fail(fmt::format("names {}, which no element has as its id", in_quotes(e.attribute("id"))));
  }
  return *found->second;
}

double number_in(const SceneElement& at, const std::string& text) {
  const std::vector<double> numbers = numbers_in(at, text, 1);
  if (numbers.empty()) at.fail("has no value; required: a number");
  return numbers[0];
}

std::vector<double> numbers_in(const SceneElement& at, const std::string& text, std::size_t most) {
  std::vector<double> out;
  std::string_view rest = text;
  while (true) {
    const auto from = rest.find_first_not_of(separators);
    if (from == std::string_view::npos) return out;
    rest.remove_prefix(from);
    const auto to = std::min(rest.find_first_of(separators), rest.size());
    if (out.size() == most) at.fail(fmt::format("has more than {} numbers", most));
    out.push_back(leading_number(at, rest.substr(0, to), "f"));
    rest.remove_prefix(to);
  }
}

const SceneElement* Parameters::peek(std::string_view name) const {
  for (const SceneElement& child : element_.children) {
    if (child.name() == name && !child.lacks_file()) return &child;
  }
  return nullptr;
}

const SceneElement* Parameters::find(std::string_view name) const {
  const SceneElement* found = peek(name);
  if (found != nullptr) found->read = true;
  return found;
}

const SceneElement* Parameters::value(std::string_view name, std::string_view tag) const {
  const SceneElement* found = find(name);
  if (found != nullptr && found->tag != tag) {
    found->fail(
        fmt::format("is {} of {}; allowed: <{}>", in_quotes(found->tag), element_.label(), tag));
  }
  return found;
}

double Parameters::number(std::string_view name, double fallback) const {
  const SceneElement* found = find(name);
  if (found == nullptr) return fallback;
  if (found->tag == "float" || found->tag == "integer") {
    return number_in(*found, found->attribute("value"));
  }
  const auto color = color_of(*found);
  if (!color) {
    found->fail(
        fmt::format("is {} of {}; allowed: <float>", in_quotes(found->tag), element_.label()));
  }
  return grey_of(*color);
}

int Parameters::integer(std::string_view name, int fallback) const {
  const SceneElement* found = find(name);
  if (found == nullptr) return fallback;
  const double value = number_in(*found, found->attribute("value"));
  if (value != std::floor(value) || std::abs(value) > 1e9) {
    found->fail(fmt::format("has {}; allowed: whole numbers up to 1e9", value));
  }
  return static_cast<int>(value);
}

bool Parameters::boolean(std::string_view name, bool fallback) const {
  const SceneElement* found = value(name, "boolean");
  if (found == nullptr) return fallback;
  const std::string text = plain_name(found->attribute("value"));
  if (text != "true" && text != "false") {
    found->fail(fmt::format("has {}; allowed: true, false", in_quotes(text)));
  }
  return text == "true";
}

std::string Parameters::text(std::string_view name, const std::string& fallback) const {
  const SceneElement* found = find(name);
  return found == nullptr ? fallback : found->attribute("value");
}

std::optional<V3d> Parameters::vector(std::string_view name) const {
  const SceneElement* found = find(name);
  if (found == nullptr) return {};
  if (found->has("value")) {
    const auto n = numbers_in(*found, found->attribute("value"), 3);
    if (n.size() != 3) found->fail("allowed: three numbers");
    return V3d(n[0], n[1], n[2]);
  }
  const auto at = [&](const char* axis) {
    return found->has(axis) ? number_in(*found, found->attribute(axis)) : 0;
  };
  return V3d(at("x"), at("y"), at("z"));
}

std::optional<Rgb> Parameters::color(std::string_view name) const {
  const SceneElement* found = peek(name);
  if (found == nullptr) return {};
  const auto color = color_of(*found);
  if (color) found->read = true;
  return color;
}

M44d Parameters::transform(std::string_view name) const {
  const SceneElement* found = find(name);
  if (found == nullptr) return {};
  if (found->tag == "animation" && !found->children.empty()) {
    return transform_of(found->children[0]);
  }
  if (found->tag != "transform") found->fail("allowed: <transform>, <animation>");
  return transform_of(*found);
}

const SceneElement* Parameters::object(std::string_view name) const {
  const SceneElement* found = find(name);
  return found == nullptr ? nullptr : &ids_.resolve(*found);
}

std::vector<const SceneElement*> Parameters::objects(std::string_view tag) const {
  std::vector<const SceneElement*> out;
  for (const auto& [name, object] : named_objects(tag)) out.push_back(object);
  return out;
}

std::vector<std::pair<std::string, const SceneElement*>> Parameters::named_objects(
    std::string_view tag) const {
  std::vector<std::pair<std::string, const SceneElement*>> out;
  for (const SceneElement& child : element_.children) {
    if (child.tag != tag && child.tag != "ref") continue;
    const SceneElement& object = ids_.resolve(child);
    if (object.tag != tag) continue;
    child.read = true;
    out.emplace_back(child.attribute("name"), &object);
  }
  return out;
}

void Parameters::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) find(name);
}

void Parameters::ignore_all() const {
  const std::function<void(const SceneElement&)> mark = [&](const SceneElement& e) {
    e.read = true;
    for (const SceneElement& child : e.children) mark(child);
  };
  mark(element_);
}

void Parameters::note_unread(std::vector<ImportNote>& notes) const {
  for (const SceneElement& child : element_.children) {
    if (child.read) {
      if (child.tag == "animation") {
        notes.push_back({child.place, element_.label(), "approximated",
                         "stands still where its animation begins"});
      }
      continue;
    }
    child.read = true;
    notes.push_back({child.place, element_.label(), "left out",
                     child.lacks_file() ? fmt::format("{} is missing", child.attribute("filename"))
                                        : fmt::format("its {} is not read", child.label())});
  }
}

}  // namespace lacuna::mitsuba
