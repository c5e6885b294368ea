#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/settings/auto_number.h"
#include "base/settings/field.h"
#include "jobs/spec/json_value.h"
#include "jobs/spec/name_or_object.h"

namespace lacuna {

enum class Colour { red, green };

template <>
struct EnumTable<Colour> {
  static constexpr std::array<EnumValue<Colour>, 2> values{{
      {Colour::red, "red", "like blood"},
      {Colour::green, "green", "like grass"},
  }};
};

struct Sphere {
  static constexpr std::string_view name = "sphere";
  static constexpr std::string_view doc = "a ball";
  double radius = 1;
  bool operator==(const Sphere&) const = default;
};
template <class V>
void describe(V& v, Sphere& s) {
  v("radius", s.radius, {.doc = "its radius", .min = 0, .above_min = true, .unit = "m"});
}

struct Box {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view doc = "a box";
  std::array<double, 3> size{1, 2, 3};
  std::string maker;
  bool operator==(const Box&) const = default;
};
template <class V>
void describe(V& v, Box& s) {
  v("size", s.size, {.doc = "edges", .min = 0, .max = 10});
  v("maker", s.maker, {.doc = "who made it", .required = true});
}

/// One member of every type that settings may have.
struct AllTypes {
  bool flag = false;
  int small = 3;
  std::int64_t wide = -5;
  std::uint64_t positive = 7;
  double real = 0.5;
  std::string word = "a";
  Colour colour = Colour::green;
  std::optional<double> maybe;
  std::optional<Colour> maybe_colour;
  std::optional<Sphere> maybe_sphere;
  std::optional<std::variant<Sphere, Box>> maybe_shape;
  AutoNumber found{4};
  NameOr<Sphere> named{"ball"};
  std::array<int, 2> pair{1, 2};
  std::vector<std::string> words;
  std::vector<Sphere> spheres;
  JsonValue anything;
  JsonTable<std::vector<int>> table;
  Sphere nested{.radius = 4};
  std::variant<Sphere, Box> shape;
  bool operator==(const AllTypes&) const = default;
};
template <class V>
void describe(V& v, AllTypes& s) {
  v("flag", s.flag, {.doc = "a flag"});
  v("small", s.small, {.doc = "int"});
  v("wide", s.wide, {.doc = "int64"});
  v("positive", s.positive, {.doc = "uint64"});
  v("real", s.real, {.doc = "double", .min = -1, .max = 1});
  v("word", s.word, {.doc = "string", .min = 1, .max = 3});
  v("colour", s.colour, {.doc = "enum"});
  v("maybe", s.maybe, {.doc = "optional double", .min = 2});
  v("maybe_colour", s.maybe_colour, {.doc = "optional enum"});
  v("maybe_sphere", s.maybe_sphere, {.doc = "optional struct"});
  v("maybe_shape", s.maybe_shape, {.doc = "optional variant"});
  v("found", s.found, {.doc = "number or auto", .min = 0, .max = 8});
  v("named", s.named, {.doc = "name or struct", .max = 8});
  v("pair", s.pair, {.doc = "array", .min = 0, .max = 9});
  v("words", s.words, {.doc = "list", .max = 2});
  v("spheres", s.spheres, {.doc = "list of structs"});
  v("anything", s.anything, {.doc = "any value"});
  v("table", s.table, {.doc = "table of lists", .max = 2});
  v("nested", s.nested, {.doc = "struct"});
  v("shape", s.shape, {.doc = "variant"});
}

}  // namespace lacuna
