#include "jobs/import/pbrt/pbrt_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace lacuna::pbrt {
namespace {

constexpr std::size_t max_parameters = 256;               // of a statement
constexpr std::size_t max_values = std::size_t{1} << 26;  // of a parameter

enum class Values { numbers, texts, either };

struct Type {
  std::string_view name, alias;
  Values values;
};
constexpr std::array<Type, 14> types{{{"integer", "int", Values::numbers},
                                      {"float", "", Values::numbers},
                                      {"point2", "", Values::numbers},
                                      {"vector2", "", Values::numbers},
                                      {"point3", "point", Values::numbers},
                                      {"vector3", "vector", Values::numbers},
                                      {"normal", "normal3", Values::numbers},
                                      {"rgb", "color", Values::numbers},
                                      {"xyz", "", Values::numbers},
                                      {"blackbody", "", Values::numbers},
                                      {"bool", "", Values::texts},
                                      {"string", "", Values::texts},
                                      {"texture", "", Values::texts},
                                      {"spectrum", "", Values::either}}};

const Type* find_type(std::string_view name) {
  const auto found = std::find_if(types.begin(), types.end(), [&](const Type& t) {
    return t.name == name || (!t.alias.empty() && t.alias == name);
  });
  return found == types.end() ? nullptr : &*found;
}

}  // namespace

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

Parameters::Parameters(Tokens& tokens, Place place, std::string owner)
    : place_(std::move(place)), owner_(std::move(owner)) {
  while (tokens.peek() && tokens.peek()->kind == Token::Kind::text) {
    const Token declaration = *tokens.next();
    const std::string_view text = declaration.text;
    Parameter p;
    p.place = declaration.place;
    const auto begin = text.find_first_not_of(" \t"), space = text.find_first_of(" \t", begin);
    const auto name = text.find_first_not_of(" \t", space);
    const Type* type =
        begin < space && space < name ? find_type(text.substr(begin, space - begin)) : nullptr;
    if (type == nullptr || name == std::string_view::npos) {
      std::string allowed;
      for (const Type& t : types)
        allowed += fmt::format("{}{}", allowed.empty() ? "" : ", ", t.name);
      fail(p.place,
           fmt::format("{}: parameter \"{}\"; allowed: \"TYPE NAME\", where TYPE is one of {}",
                       owner_, text, allowed));
    }
    p.type = type->name;
    p.name = text.substr(name, text.find_last_not_of(" \t") + 1 - name);
    read_values(tokens, p);
    if (parameters_.size() == max_parameters) {
      fail(p.place, fmt::format("{}: more than {} parameters", owner_, max_parameters));
    }
    parameters_.push_back(std::move(p));
  }
}

void Parameters::read_values(Tokens& tokens, Parameter& p) const {
  const Values kind = find_type(p.type)->values;
  const auto take = [&](const Token& t) {
    if (p.numbers.size() + p.texts.size() == max_values) {
      fail(t.place, fmt::format("parameter \"{}\" has more than {} values", p.name, max_values));
    }
    const auto number = t.kind == Token::Kind::word ? number_of(t.text) : std::nullopt;
    const bool is_text = t.kind == Token::Kind::text ||
                         (p.type == "bool" && (t.text == "true" || t.text == "false"));
    if (number && kind != Values::texts) {
      p.numbers.push_back(number.value_or(0));  // GCC 12 does not see that there is one
    } else if (is_text && kind != Values::numbers) {
      p.texts.emplace_back(t.text);
    } else {
      fail(t.place, fmt::format("{}: value {} of parameter \"{} {}\"; allowed: {}", owner_, t.text,
                                p.type, p.name,
                                kind == Values::numbers ? "finite numbers"
                                : kind == Values::texts ? "texts in quotes"
                                                        : "finite numbers or a text in quotes"));
    }
  };
  const auto end = [&] {
    fail(p.place,
         fmt::format("{}: parameter \"{}\" has no value, or its ] is missing", owner_, p.name));
  };
  const auto first = tokens.next();
  if (!first || first->kind == Token::Kind::close) end();
  if (first->kind != Token::Kind::open) return take(*first);
  while (true) {
    const auto t = tokens.next();
    if (!t || t->kind == Token::Kind::open) end();
    if (t->kind == Token::Kind::close) return;
    take(*t);
  }
}

Parameters Parameters::copy_for(const Place& place, const std::string& owner) const {
  Parameters out = *this;
  out.place_ = place;
  out.owner_ = owner;
  for (const Parameter& p : out.parameters_) p.used = false;
  return out;
}

void Parameters::add_defaults(const Parameters& defaults) {
  for (const Parameter& d : defaults.parameters_) {
    const auto same = [&](const Parameter& p) { return p.name == d.name; };
    if (std::any_of(parameters_.begin(), parameters_.end(), same)) continue;
    parameters_.push_back(d);
    parameters_.back().used = true;  // it need not suit each statement
  }
}

const Parameter* Parameters::find(std::string_view name,
                                  std::initializer_list<std::string_view> allowed) const {
  const auto is_it = [&](const Parameter& p) {
    return p.name == name && std::find(allowed.begin(), allowed.end(), p.type) != allowed.end();
  };
  const auto found = std::find_if(parameters_.rbegin(), parameters_.rend(), is_it);
  if (found == parameters_.rend()) return nullptr;
  found->used = true;
  return &*found;
}

const Parameter* Parameters::find_spectrum(std::string_view name) const {
  return find(name, {"rgb", "xyz", "spectrum", "blackbody"});
}

const Parameter& Parameters::single(const Parameter& p) const {
  const std::size_t n = p.numbers.size() + p.texts.size();
  if (n == 1) return p;
  fail(p.place, fmt::format("{}: parameter \"{}\" has {} values; allowed: one", owner_, p.name, n));
}

std::optional<double> Parameters::number(std::string_view name) const {
  const Parameter* p = find(name, {"float", "integer"});
  if (p == nullptr) return {};
  return single(*p).numbers[0];
}

double Parameters::number(std::string_view name, double otherwise) const {
  return number(name).value_or(otherwise);
}

double Parameters::number_in(std::string_view name, double otherwise, double least,
                             double most) const {
  const double x = number(name, otherwise);
  if (x >= least && x <= most) return x;
  const Parameter* p = find(name, {"float", "integer"});
  fail(p != nullptr ? p->place : place_,
       fmt::format("{}: \"{}\" is {}; allowed: {} to {}", owner_, name, x, least, most));
}

int Parameters::integer(std::string_view name, int otherwise, int least, int most) const {
  const double x = number_in(name, otherwise, least, most);
  if (x == std::floor(x)) return static_cast<int>(x);
  fail(place_, fmt::format("{}: \"{}\" is {}; allowed: whole numbers", owner_, name, x));
}

bool Parameters::boolean(std::string_view name, bool otherwise) const {
  const Parameter* p = find(name, {"bool"});
  if (p == nullptr) return otherwise;
  const std::string& text = single(*p).texts[0];
  if (text == "true" || text == "false") return text == "true";
  fail(p->place, fmt::format("{}: \"{}\" is \"{}\"; allowed: true, false", owner_, name, text));
}

std::string Parameters::text(std::string_view name, const std::string& otherwise) const {
  const Parameter* p = find(name, {"string"});
  return p == nullptr ? otherwise : single(*p).texts[0];
}

V3d Parameters::point(std::string_view name, const V3d& otherwise) const {
  const auto g = groups(name, 3, {"point3", "vector3", "normal"});
  if (g.empty()) return otherwise;
  if (g.size() != 3) fail(place_, fmt::format("{}: \"{}\" is more than one point", owner_, name));
  return {g[0], g[1], g[2]};
}

std::span<const double> Parameters::groups(std::string_view name, std::size_t size,
                                           std::initializer_list<std::string_view> allowed) const {
  const Parameter* p = find(name, allowed);
  if (p == nullptr) return {};
  if (p->numbers.size() % size == 0) return p->numbers;
  fail(p->place, fmt::format("{}: \"{}\" has {} values; allowed: a multiple of {}", owner_, name,
                             p->numbers.size(), size));
}

std::vector<std::uint32_t> Parameters::indices(std::string_view name, std::size_t group,
                                               std::size_t count) const {
  std::vector<std::uint32_t> out;
  for (const double x : groups(name, group, {"integer"})) {
    if (!(x >= 0 && x < static_cast<double>(count)) || x != std::floor(x)) {
      fail(place_,
           fmt::format("{}: \"{}\" contains {}; allowed: whole numbers below {}, the number "
                       "of points",
                       owner_, name, x, count));
    }
    out.push_back(static_cast<std::uint32_t>(x));
  }
  return out;
}

void Parameters::ignore(std::initializer_list<std::string_view> names) const {
  for (const Parameter& p : parameters_) {
    if (std::find(names.begin(), names.end(), p.name) != names.end()) p.used = true;
  }
}

std::vector<const Parameter*> Parameters::unused() const {
  std::vector<const Parameter*> out;
  for (const Parameter& p : parameters_) {
    if (!p.used) out.push_back(&p);
  }
  return out;
}

}  // namespace lacuna::pbrt
