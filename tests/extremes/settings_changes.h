#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <variant>

#include "jobs/spec/described.h"
#include "jobs/spec/limits.h"
#include "tests/extremes/methods.h"

namespace lacuna::extremes {

/// The part of a visitor of settings tables that walks into what is nested, and counts: of all
/// changes that could be made, the one with the number asked for is.
class OneChange {
 public:
  explicit OneChange(int wanted) : wanted_(wanted) {}
  /// " guide.radius=3": what was changed; empty: there are not so many changes.
  const std::string& made() const { return made_; }

 protected:
  bool is_next() { return count_++ == wanted_; }
  void note(std::string_view name, std::string_view value) {
    made_ = " " + path_ + std::string(name) + "=" + std::string(value);
  }
  /// Visits what `member` holds, if it has a table; what is optional as if it were there.
  template <class Visitor, class T>
  void enter(Visitor& visitor, std::string_view name, T& member, const Field& field) {
    if constexpr (is_optional<T>) {
      auto value = member.value_or(typename T::value_type{});
      const bool before = made_.empty();
      visitor(name, value, field);
      if (before && !made_.empty()) member = value;
    } else if constexpr (is_variant<T> || Described<T>) {
      const std::size_t outside = path_.size();
      path_ += std::string(name) + ".";
      if constexpr (is_variant<T>) {
        std::visit([&](auto& settings) { describe(visitor, settings); }, member);
      } else {
        describe(visitor, member);
      }
      path_.resize(outside);
    }
  }

 private:
  int wanted_, count_ = 0;
  std::string path_, made_;
};

/// Another alternative of a choice, with its defaults.
class OtherChoice : public OneChange {
 public:
  using OneChange::OneChange;
  template <class T>
  void operator()(std::string_view name, T& member, const Field& field) {
    if constexpr (is_variant<T>) choose(name, member);
    enter(*this, name, member, field);
  }

 private:
  template <class... Ts>
  void choose(std::string_view name, std::variant<Ts...>& member) {
    const std::size_t now = member.index();
    std::size_t index = 0;
    const auto offer = [&](auto other) {
      if (index++ != now && is_next()) note(name, other.name), member = other;
    };
    (offer(Ts{}), ...);
  }
};

/// Another value of a flag or of an enum; a number that is left to the method.
class OtherFlag : public OneChange {
 public:
  using OneChange::OneChange;
  template <class T>
  void operator()(std::string_view name, T& member, const Field& field) {
    if constexpr (std::is_same_v<T, bool>) {
      if (is_next()) member = !member, note(name, member ? "true" : "false");
    } else if constexpr (std::is_same_v<T, AutoNumber>) {
      if (!member.is_auto() && is_next()) member = {}, note(name, auto_name);
    } else if constexpr (NamedEnum<T>) {
      const T now = member;
      for (const auto& v : EnumTable<T>::values) {
        if (v.value != now && is_next()) member = v.value, note(name, v.name);
      }
    } else {
      enter(*this, name, member, field);
    }
  }
};

/// A number at an end of its range.
class NumberAt : public OneChange {
 public:
  NumberAt(int wanted, End end) : OneChange(wanted), end_(end) {}
  template <class T>
  void operator()(std::string_view name, T& member, const Field& field) {
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      const double value = at_end(limits_of<T>(field), std::is_integral_v<T>);
      if (std::isfinite(value) && is_next()) {
        member = static_cast<T>(value);
        note(name, number_text(value));
      }
    } else if constexpr (std::is_same_v<T, AutoNumber>) {
      double number = member.value.value_or(0);
      const bool before = made().empty();
      (*this)(name, number, field);
      if (before && !made().empty()) member = {number};
    } else if constexpr (is_array<T> || is_vector<T>) {
      for (auto& element : member) (*this)(name, element, field);
    } else {
      enter(*this, name, member, field);
    }
  }

 private:
  double at_end(const Limits& limits, bool integral) const {
    const auto inside = [&](double end, double other) {
      return integral ? end + std::copysign(1, other - end) : std::nextafter(end, other);
    };
    switch (end_) {
      case End::lowest:
        return limits.above_min ? inside(limits.min, limits.max) : limits.min;
      case End::highest:
        return limits.max;
      case End::below:
        if (limits.above_min) return limits.min;
        // Threads that render take denormal numbers for zero.
        if (limits.min == 0 && !integral) return -std::numeric_limits<double>::min();
        return inside(limits.min, -HUGE_VAL);
      case End::above:
        return inside(limits.max, HUGE_VAL);
    }
    return NAN;
  }

  End end_;
};

}  // namespace lacuna::extremes
