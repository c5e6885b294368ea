#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/json/json_text.h"
#include "base/json/limits.h"

namespace lacuna {

/// Takes what a reader finds wrong with a document. Where it throws, the reading ends.
class JsonProblems {
 public:
  virtual ~JsonProblems() = default;
  /// `pointer` is a JSON pointer (RFC 6901) into the document; `message` says what was found there
  /// and what is allowed.
  virtual void add(const std::string& pointer, const std::string& message) = 0;
};

/// One value of a parsed document, and where it stands. A read checks the type and the range; where
/// the value is not what is allowed, it adds a problem and gives nothing (or false). The document
/// and `problems` outlive the cursor.
class JsonCursor {
 public:
  JsonCursor(const Json& value, std::string pointer, JsonProblems& problems)
      : value_(&value), pointer_(std::move(pointer)), problems_(&problems) {}

  const Json& value() const { return *value_; }
  const std::string& pointer() const { return pointer_; }

  /// Another value in this one's place: what a short form stands for.
  JsonCursor in_place(const Json& value) const { return {value, pointer_, *problems_}; }
  /// The member of an object, or the element of a list, that is known to be there.
  JsonCursor at(std::string_view key) const;
  JsonCursor at(std::size_t index) const;
  /// The member of an object; none if the key is absent.
  std::optional<JsonCursor> find(std::string_view key) const;

  std::optional<bool> boolean() const;
  std::optional<double> number(const Limits& limits) const;
  /// Limits within +-2^53. 512.0 and 1e3 are integers, too.
  std::optional<std::int64_t> integer(const Limits& limits) const;
  /// Limits from 0. Digits alone, as glTF writes integers: neither 512.0 nor 1e3.
  std::optional<std::uint64_t> digits(const Limits& limits) const;
  std::optional<std::string> string() const;
  bool check_object() const;
  bool check_list(const Limits& length = {}) const;
  /// A list of so many elements.
  bool check_list_of(std::size_t size) const;

  /// Adds the problem "found string "abc"; allowed: ...".
  void refuse(const std::string& allowed) const;
  /// Adds the problem of a member that is not there: "missing; required: ...".
  void refuse_missing(std::string_view key, std::string_view required) const;
  void add_problem(const std::string& message) const { problems_->add(pointer_, message); }
  /// A problem of a member that need not be there.
  void add_problem(std::string_view key, const std::string& message) const;

 private:
  const Json* value_;
  std::string pointer_;
  JsonProblems* problems_;
};

/// `base` with one more reference token, escaped (RFC 6901).
std::string child_pointer(const std::string& base, std::string_view key);

/// A string as it would stand in JSON, in printable ASCII, cut where it is long.
std::string in_quotes(std::string_view text);
/// The type of a value and, of anything but an object or a list, the value, cut where it is long.
std::string shown(const Json& value);

/// "THING LIMITS", or the thing alone where the text of its limits is empty.
std::string with_limits(std::string_view thing, const std::string& limits);

}  // namespace lacuna
