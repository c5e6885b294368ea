#pragma once

#include <optional>
#include <string>
#include <utility>

namespace lacuna {

/// A member that is the name of something that exists elsewhere, or an object that describes it. A
/// document contains a string, or an object with T's settings.
template <class T>
struct NameOr {
  std::string name;  ///< unused if there is an object
  std::optional<T> object;

  NameOr() = default;
  NameOr(std::string of) : name(std::move(of)) {}
  NameOr(const char* of) : name(of) {}
  /// Whether neither a name nor an object is given.
  bool is_default() const { return name.empty() && !object; }
  bool operator==(const NameOr&) const = default;
};

template <class>
inline constexpr bool is_name_or = false;
template <class T>
inline constexpr bool is_name_or<NameOr<T>> = true;

/// A member that is one of an enum's words, or an object with T's settings.
template <class E, class T>
struct WordOr {
  E word{};  ///< unused if there is an object
  std::optional<T> object;

  WordOr() = default;
  WordOr(E of) : word(of) {}
  WordOr(T of) : object(std::move(of)) {}
  bool operator==(const WordOr&) const = default;
};

template <class>
inline constexpr bool is_word_or = false;
template <class E, class T>
inline constexpr bool is_word_or<WordOr<E, T>> = true;

}  // namespace lacuna
