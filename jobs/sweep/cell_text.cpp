#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "jobs/sweep/expand.h"
#include "jobs/sweep/pointer.h"

namespace lacuna {
namespace {

/// The last `parts` tokens of a pointer.
std::string ending(const std::vector<std::string>& tokens, std::size_t parts) {
  const std::size_t n = std::min(parts, tokens.size());
  return fmt::format("{}",
                     fmt::join(tokens.end() - static_cast<std::ptrdiff_t>(n), tokens.end(), "/"));
}

/// The shortest ending that is unique among the pointers.
std::string short_name(const std::string& pointer, const JsonTable<JsonValue>& all) {
  const auto tokens = pointer_tokens(pointer);
  for (std::size_t parts = 1; parts < tokens.size(); ++parts) {
    std::string name = ending(tokens, parts);
    const auto same = [&](const auto& other) {
      return other.first != pointer && ending(pointer_tokens(other.first), parts) == name;
    };
    if (std::none_of(all.begin(), all.end(), same)) return name;
  }
  return ending(tokens, tokens.size());
}

/// Whether all cells of `some` have the same value there.
template <class Cells, class CellOf>
bool agree(const Cells& some, const std::string& pointer, CellOf&& cell_of) {
  const JsonValue& first = cell_of(*some.begin()).settings.at(pointer);
  return std::all_of(some.begin(), some.end(),
                     [&](const auto& c) { return cell_of(c).settings.at(pointer) == first; });
}

}  // namespace

VaryingSettings settings_that_vary(const SweepPlan& plan, const std::vector<std::size_t>& cells) {
  VaryingSettings found;
  const auto itself = [](const SweepCell& c) -> const SweepCell& { return c; };
  const auto numbered = [&](std::size_t c) -> const SweepCell& { return plan.cells[c]; };
  for (const auto& [pointer, value] : plan.cells[cells.front()].settings) {
    if (!agree(cells, pointer, numbered)) {
      found.vary.push_back(pointer);
    } else if (!agree(plan.cells, pointer, itself)) {
      found.shared[pointer] = value;
    }
  }
  return found;
}

namespace {

/// A value in a cell's text: strings without quotes, an object by its type with its other keys in
/// brackets, another program by its name.
std::string value_text(const OrderedJson& v) {
  if (v.is_string()) return v.get<std::string>();
  if (!v.is_object()) return json_text(v);
  const auto text_of = [&v](const char* key) {
    const auto found = v.find(key);
    return found != v.end() && found->is_string() ? found->get<std::string>() : "";
  };
  const std::string type = text_of("type");
  if (type == ForeignSettings::name && !text_of("name").empty()) return text_of("name");
  std::vector<std::string> others;
  for (const auto& [key, value] : v.items()) {
    if (key != "type" || type.empty()) others.push_back(key + " " + value_text(value));
  }
  if (type.empty()) return fmt::format("{}", fmt::join(others, ", "));
  return others.empty() ? type : fmt::format("{} ({})", type, fmt::join(others, ", "));
}

}  // namespace

std::string cell_text(const JsonTable<JsonValue>& settings) {
  std::string text;
  for (const auto& [pointer, value] : settings) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", short_name(pointer, settings),
                        value_text(parse_own(value.text)));
  }
  return text;
}

}  // namespace lacuna
