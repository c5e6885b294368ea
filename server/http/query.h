#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

/// The parameters of a URL, "state=done&limit=10", decoded: %XX is a byte and + a blank.
class Query {
 public:
  Query() = default;
  /// `sent`: the text after the ?. Throws HttpError 400 for an invalid escape, a second "=" in a
  /// parameter, a control character, text that is not UTF-8, an empty name and a repeated name.
  /// (The HTTP library ignores all of these.)
  explicit Query(std::string_view sent);

  bool has(const std::string& name) const { return values_.contains(name); }
  std::optional<std::string> text(const std::string& name) const;
  /// A decimal integer in [min, max]. Throws HttpError 400.
  std::optional<std::int64_t> integer(const std::string& name, std::int64_t min = INT64_MIN,
                                      std::int64_t max = INT64_MAX) const;
  /// "1" or "true", "0" or "false"; false if it is absent. Throws HttpError 400.
  bool flag(const std::string& name) const;
  /// Throws HttpError 400 for a parameter with another name.
  void check_known(const std::vector<std::string>& names) const;

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace lacuna
