#include "renderer/gltf/gltf_json.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {
namespace {

/// What was found, short enough for a message whatever it is.
std::string describe(const Json& found) {
  if (found.is_object()) return "an object";
  if (found.is_array()) return "an array of " + std::to_string(found.size()) + " elements";
  constexpr std::size_t longest = 80;
  std::string text = found.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

std::string describe(Range allowed) {
  std::ostringstream text;
  text << "a number";
  const bool low = allowed.low > any_float.low;
  const bool high = allowed.high < any_float.high;
  if (low && high) text << " from " << allowed.low << " to " << allowed.high;
  if (low && !high) text << ", at least " << allowed.low;
  if (!low && high) text << ", at most " << allowed.high;
  return text.str();
}

}  // namespace

Place::Place(const Json& value, std::string path) : value_(&value), path_(std::move(path)) {
  if (!value.is_object()) {
    throw SceneError((path_.empty() ? "the JSON" : path_) + " is " + describe(value) +
                     "; allowed: an object");
  }
}

std::string Place::label() const {
  const Json* name = find("name");
  return name != nullptr && name->is_string() ? path_ + " " + describe(*name) : path_;
}

const Json* Place::find(std::string_view key) const {
  const auto it = value_->find(key);
  return it == value_->end() ? nullptr : &*it;
}

std::string Place::path_of(std::string_view key) const {
  const std::string shown = label();
  return (shown.empty() ? "" : shown + ": ") + std::string(key);
}

void Place::refuse_json(std::string_view key, const Json& found, const std::string& allowed) const {
  throw SceneError(path_of(key) + " is " + describe(found) + "; allowed: " + allowed);
}

void Place::refuse(std::string_view key, const std::string& found,
                   const std::string& allowed) const {
  refuse_json(key, found, allowed);
}

void Place::refuse(std::string_view key, double found, const std::string& allowed) const {
  refuse_json(key, found, allowed);
}

void Place::fail(const std::string& message) const {
  const std::string shown = label();
  throw SceneError((shown.empty() ? "" : shown + ": ") + message);
}

const Json& Place::require(std::string_view key, const std::string& allowed) const {
  const Json* found = find(key);
  if (found == nullptr) throw SceneError(path_of(key) + " is missing; required: " + allowed);
  return *found;
}

double Place::checked_number(std::string_view key, const Json& found, Range allowed) const {
  // A NaN cannot be written in JSON and the parser refuses overflow, so every number is finite.
  if (!found.is_number()) refuse_json(key, found, describe(allowed));
  const auto value = found.get<double>();
  if (!(value >= allowed.low && value <= allowed.high)) refuse_json(key, found, describe(allowed));
  return value;
}

double Place::number(std::string_view key, double fallback, Range allowed) const {
  const Json* found = find(key);
  return found == nullptr ? fallback : checked_number(key, *found, allowed);
}

double Place::number(std::string_view key, Range allowed) const {
  return checked_number(key, require(key, describe(allowed)), allowed);
}

std::uint64_t Place::integer(std::string_view key, std::uint64_t low, std::uint64_t high) const {
  const std::string allowed =
      "an integer from " + std::to_string(low) + " to " + std::to_string(high);
  const Json& found = require(key, allowed);
  // nlohmann would turn -1 into 2^64-1 and 1.9 into 1.
  if (!found.is_number_unsigned()) refuse_json(key, found, allowed);
  const auto value = found.get<std::uint64_t>();
  if (value < low || value > high) refuse_json(key, found, allowed);
  return value;
}

std::uint64_t Place::integer(std::string_view key, std::uint64_t fallback, std::uint64_t low,
                             std::uint64_t high) const {
  return has(key) ? integer(key, low, high) : fallback;
}

bool Place::boolean(std::string_view key, bool fallback) const {
  const Json* found = find(key);
  if (found == nullptr) return fallback;
  if (!found->is_boolean()) refuse_json(key, *found, "true or false");
  return found->get<bool>();
}

std::string Place::string(std::string_view key) const {
  const Json& found = require(key, "a string");
  if (!found.is_string()) refuse_json(key, found, "a string");
  return found.get<std::string>();
}

std::string Place::string(std::string_view key, const std::string& fallback) const {
  return has(key) ? string(key) : fallback;
}

std::optional<std::size_t> Place::index(std::string_view key, std::size_t size,
                                        std::string_view target) const {
  const Json* found = find(key);
  if (found == nullptr) return std::nullopt;
  if (!found->is_number_unsigned() || found->get<std::uint64_t>() >= size) {
    refuse_json(key, *found,
                "an index below " + std::to_string(size) + " (" + std::string(target) + ")");
  }
  return found->get<std::size_t>();
}

std::vector<std::size_t> Place::indices(std::string_view key, std::size_t size,
                                        std::string_view target) const {
  std::vector<std::size_t> out;
  const Json* found = array(key);
  if (found == nullptr) return out;
  for (const Json& item : *found) {
    if (!item.is_number_unsigned() || item.get<std::uint64_t>() >= size) {
      refuse_json(std::string(key) + "[" + std::to_string(out.size()) + "]", item,
                  "an index below " + std::to_string(size) + " (" + std::string(target) + ")");
    }
    out.push_back(item.get<std::size_t>());
  }
  return out;
}

void Place::numbers(std::string_view key, Range allowed, std::size_t count, double* out) const {
  const Json& found = *find(key);
  if (!found.is_array() || found.size() != count) {
    refuse_json(key, found, "an array of " + std::to_string(count) + " numbers");
  }
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = checked_number(std::string(key) + "[" + std::to_string(i) + "]", found[i], allowed);
  }
}

std::optional<Place> Place::object(std::string_view key) const {
  const Json* found = find(key);
  if (found == nullptr) return std::nullopt;
  return Place(*found, path_.empty() ? std::string(key) : path_ + "." + std::string(key));
}

std::optional<Place> Place::extension(std::string_view name) const {
  const auto extensions = object("extensions");
  return extensions ? extensions->object(name) : std::nullopt;
}

const Json* Place::array(std::string_view key) const {
  const Json* found = find(key);
  if (found != nullptr && !found->is_array()) refuse_json(key, *found, "an array");
  return found;
}

std::vector<Place> Place::objects(std::string_view key) const {
  std::vector<Place> out;
  const Json* found = array(key);
  if (found == nullptr) return out;
  const std::string prefix = path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  out.reserve(found->size());
  for (const Json& item : *found) {
    out.emplace_back(item, prefix + "[" + std::to_string(out.size()) + "]");
  }
  return out;
}

std::vector<std::string> Place::strings(std::string_view key) const {
  std::vector<std::string> out;
  const Json* found = array(key);
  if (found == nullptr) return out;
  for (const Json& item : *found) {
    if (!item.is_string()) {
      refuse_json(std::string(key) + "[" + std::to_string(out.size()) + "]", item, "a string");
    }
    out.push_back(item.get<std::string>());
  }
  return out;
}

std::vector<std::string> Place::keys() const {
  std::vector<std::string> out;
  for (const auto& item : value_->items()) out.push_back(item.key());
  return out;
}

std::size_t Place::array_size(std::string_view key) const {
  const Json* found = array(key);
  return found == nullptr ? 0 : found->size();
}

}  // namespace lacuna::gltf
