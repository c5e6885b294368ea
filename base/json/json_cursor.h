#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/json/json_text.h"
#include "base/json/limits.h"

namespace lacuna {

/// Receives the problems that a reader finds in a document. An exception from add() ends the
/// reading.
class JsonProblems {
 public:
  virtual ~JsonProblems() = default;
  /// `pointer` is a JSON pointer (RFC 6901) into the document; `message` says what was found there
  /// and what is allowed.
  virtual void add(const std::string& pointer, const std::string& message) = 0;
};

/// A value of a parsed document and its position. Each read checks type and range; for a value that
/// is not allowed it adds a problem and returns none (or false). The document and `problems` must
/// outlive the cursor.
class JsonCursor {
 public:
  JsonCursor(const Json& value, std::string pointer, JsonProblems& problems)
      : value_(&value), pointer_(std::move(pointer)), problems_(&problems) {}

  const Json& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }

  /// A cursor to another value at the same position: the expansion of a short form.
  JsonCursor in_place(const Json& value) const { return {value, pointer_, *problems_}; }
  /// A member of an object, or an element of a list, which must exist.
  JsonCursor at(std::string_view key) const;
  JsonCursor at(std::size_t index) const;
  /// The member of an object; none if the key is absent.
  std::optional<JsonCursor> find(std::string_view key) const;

  std::optional<bool> boolean() const;
  std::optional<double> number(const Limits& limits) const;
  /// `limits` lie within +-2^53. Accepts 512.0 and 1e3, too.
  std::optional<std::int64_t> integer(const Limits& limits) const;
  /// `limits` are not negative. Accepts digits only, as glTF writes integers: not 512.0 or 1e3.
  std::optional<std::uint64_t> digits(const Limits& limits) const;
  std::optional<std::string> string() const;
  bool check_object() const;
  bool check_list(const Limits& length = {}) const;
  /// A list of exactly `size` elements.
  bool check_list_of(std::size_t size) const;

  /// Adds the problem "found string "abc"; allowed: ...".
  void refuse(const std::string& allowed) const;
  /// Adds the problem of a missing member: "missing; required: ...".
  void refuse_missing(std::string_view key, std::string_view required) const;
  void add_problem(const std::string& message) const { problems_->add(pointer_, message); }
  /// Adds a problem of a member, which may be missing.
  void add_problem(std::string_view key, const std::string& message) const;

 private:
  const Json* value_;
  std::string pointer_;
  JsonProblems* problems_;
};

/// `base` with one more reference token, escaped (RFC 6901).
std::string child_pointer(const std::string& base, std::string_view key);

/// A string as JSON, in printable ASCII, truncated if it is long.
std::string in_quotes(std::string_view text);
/// The type of a value and, unless it is an object or a list, the value, truncated if it is long.
std::string shown(const Json& value);

/// "THING LIMITS", or only the thing if the text of its limits is empty.
std::string with_limits(std::string_view thing, const std::string& limits);

}  // namespace lacuna
