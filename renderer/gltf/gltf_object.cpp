#include "renderer/gltf/gltf_object.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "renderer/core/scene_error.h"

namespace lacuna::gltf {
namespace {

/// The reference tokens of a JSON pointer (RFC 6901).
std::vector<std::string> tokens(std::string_view pointer) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      out.emplace_back();
    } else if (pointer[i] == '~') {
      out.back() += pointer[++i] == '1' ? '/' : '~';
    } else {
      out.back() += pointer[i];
    }
  }
  return out;
}

/// `x`, clamped to the range if it is slightly outside.
double without_hair(double x, const Limits& allowed) {
  const bool open = allowed.max >= std::numeric_limits<float>::max();
  const double larger_end = std::max(std::abs(allowed.min), open ? 1 : std::abs(allowed.max));
  const double end = std::clamp(x, allowed.min, allowed.max);
  return std::abs(x - end) <= hair * larger_end ? end : x;
}

std::size_t checked_index(const JsonCursor& found, std::size_t size, std::string_view target) {
  const Json& value = found.value();
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= size) {
    found.refuse("an index below " + std::to_string(size) + " (" + std::string(target) + ")");
  }
  return value.get<std::size_t>();
}

}  // namespace

void GltfProblems::add(const std::string& pointer, const std::string& message) {
  const std::string where = place(pointer);
  throw SceneError(where.empty() ? message : where + ": " + message);
}

void GltfProblems::warn(const std::string& kind, const std::string& pointer,
                        const std::string& message) {
  warnings_.first_of(kind, place(pointer) + ": " + message);
}

std::string GltfProblems::place(const std::string& pointer) const {
  const Json* value = &root_;  // null where nothing is
  std::string object;          // the innermost one
  std::string name;            // of it
  std::string rest;            // from there on
  for (const std::string& token : tokens(pointer)) {
    if (value != nullptr && value->is_array()) {
      rest += '[' + token + ']';
      value = &(*value)[std::stoul(token)];
    } else {
      rest += rest.empty() ? token : '.' + token;
      const bool there = value != nullptr && value->contains(token);
      value = there ? &(*value)[token] : nullptr;
    }
    if (value == nullptr || !value->is_object()) continue;
    object += object.empty() ? rest : '.' + rest;
    rest.clear();
    const auto own = value->find("name");
    const bool named = own != value->end() && own->is_string();
    name = named ? ' ' + in_quotes(own->get_ref<const std::string&>()) : "";
  }
  if (object.empty()) return rest;
  return rest.empty() ? object + name : object + name + ": " + rest;
}

GltfObject::GltfObject(JsonCursor cursor, GltfProblems& problems)
    : cursor_(std::move(cursor)), problems_(&problems) {
  cursor_.check_object();
}

JsonCursor GltfObject::require(std::string_view key, std::string_view required) const {
  auto found = cursor_.find(key);
  if (!found) cursor_.refuse_missing(key, required);
  return std::move(found).value();
}

std::vector<JsonCursor> GltfObject::elements(std::string_view key) const {
  std::vector<JsonCursor> out;
  const auto list = cursor_.find(key);
  if (!list) return out;
  list->check_list();
  out.reserve(list->value().size());
  for (std::size_t i = 0; i < list->value().size(); ++i) out.push_back(list->at(i));
  return out;
}

bool GltfObject::has(std::string_view key) const { return cursor_.value().contains(key); }

double GltfObject::number(std::string_view key, double fallback, const Limits& allowed) const {
  const auto found = cursor_.find(key);
  return found ? read(*found, key, allowed) : fallback;
}

double GltfObject::number(std::string_view key, const Limits& allowed) const {
  return read(require(key, "a number"), key, allowed);
}

double GltfObject::read(const JsonCursor& found, std::string_view key,
                        const Limits& allowed) const {
  if (!found.value().is_number()) return found.number(allowed).value();  // refuses it
  const double x = found.value().get<double>();
  const double nearest = without_hair(x, allowed);
  if (!allowed.allow(nearest)) return found.number(allowed).value();
  if (nearest != x) {
    problems_->warn(std::string(key), found.pointer(),
                    "found number " + number_text(x) + "; allowed: a number " +
                        range_text(allowed) + "; it is read as " + number_text(nearest));
  }
  return nearest;
}

std::vector<double> GltfObject::number_list(std::string_view key, const Limits& allowed) const {
  std::vector<double> out;
  for (const JsonCursor& item : elements(key)) out.push_back(read(item, key, allowed));
  return out;
}

std::vector<double> GltfObject::one_or_more(std::string_view key, const Limits& allowed) const {
  const auto found = cursor_.find(key);
  if (found && found->value().is_number()) return {read(*found, key, allowed)};
  return number_list(key, allowed);
}

std::optional<std::array<double, 3>> GltfObject::light_colour(std::string_view key) const {
  const auto colour = numbers<3>(key, non_negative);
  if (colour && *std::max_element(colour->begin(), colour->end()) > 1) {
    problems_->warn(std::string(key), child_pointer(cursor_.pointer(), key),
                    "found components up to " +
                        number_text(*std::max_element(colour->begin(), colour->end())) +
                        "; glTF allows up to 1; they are read as more light");
  }
  return colour;
}

std::uint64_t GltfObject::integer(std::string_view key, std::uint64_t low,
                                  std::uint64_t high) const {
  const Limits allowed{static_cast<double>(low), static_cast<double>(high)};
  return require(key, "an integer").digits(allowed).value();
}

std::uint64_t GltfObject::integer(std::string_view key, std::uint64_t fallback, std::uint64_t low,
                                  std::uint64_t high) const {
  return has(key) ? integer(key, low, high) : fallback;
}

bool GltfObject::boolean(std::string_view key, bool fallback) const {
  const auto found = cursor_.find(key);
  return found ? found->boolean().value() : fallback;
}

std::string GltfObject::string(std::string_view key) const {
  return require(key, "a string").string().value();
}

std::string GltfObject::string(std::string_view key, const std::string& fallback) const {
  const auto found = cursor_.find(key);
  return found ? found->string().value() : fallback;
}

std::optional<std::size_t> GltfObject::index(std::string_view key, std::size_t size,
                                             std::string_view target) const {
  const auto found = cursor_.find(key);
  if (!found) return std::nullopt;
  return checked_index(*found, size, target);
}

std::vector<std::size_t> GltfObject::indices(std::string_view key, std::size_t size,
                                             std::string_view target) const {
  std::vector<std::size_t> out;
  for (const JsonCursor& item : elements(key)) out.push_back(checked_index(item, size, target));
  return out;
}

std::vector<std::vector<std::size_t>> GltfObject::index_lists(std::string_view key,
                                                              std::size_t size,
                                                              std::string_view target) const {
  std::vector<std::vector<std::size_t>> out;
  for (const JsonCursor& list : elements(key)) {
    list.check_list();
    out.emplace_back();
    for (std::size_t i = 0; i < list.value().size(); ++i) {
      out.back().push_back(checked_index(list.at(i), size, target));
    }
  }
  return out;
}

std::optional<GltfObject> GltfObject::object(std::string_view key) const {
  auto found = cursor_.find(key);
  if (!found) return std::nullopt;
  return GltfObject(std::move(*found), *problems_);
}

std::string GltfObject::extra(std::string_view key) const {
  const auto extras = cursor_.find("extras");
  if (!extras || !extras->value().is_object()) return {};
  const auto found = extras->find(key);
  return found && found->value().is_string() ? found->value().get<std::string>() : std::string();
}

std::optional<GltfObject> GltfObject::extension(std::string_view name) const {
  const auto extensions = object("extensions");
  return extensions ? extensions->object(name) : std::nullopt;
}

std::vector<GltfObject> GltfObject::objects(std::string_view key) const {
  std::vector<GltfObject> out;
  for (JsonCursor& item : elements(key)) out.push_back(GltfObject(std::move(item), *problems_));
  return out;
}

std::vector<std::string> GltfObject::strings(std::string_view key) const {
  std::vector<std::string> out;
  for (const JsonCursor& item : elements(key)) out.push_back(item.string().value());
  return out;
}

std::vector<std::string> GltfObject::keys() const {
  std::vector<std::string> out;
  for (const auto& item : cursor_.value().items()) out.push_back(item.key());
  return out;
}

std::size_t GltfObject::array_size(std::string_view key) const {
  const auto list = cursor_.find(key);
  if (!list) return 0;
  list->check_list();
  return list->value().size();
}

void GltfObject::refuse(std::string_view key, const std::string& allowed) const {
  const JsonCursor found = cursor_.at(key);
  problems_->add(found.pointer(), "found " + shown(found.value()) + "; allowed: " + allowed);
}

void GltfObject::fail(const std::string& message) const {
  problems_->add(cursor_.pointer(), message);
}

void GltfObject::warn(const std::string& kind, const std::string& message) const {
  problems_->warn(kind, cursor_.pointer(), message);
}

}  // namespace lacuna::gltf
