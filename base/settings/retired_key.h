#pragma once

#include <string_view>

namespace lacuna {

/// A key that settings had in an earlier version. Stored jobs have it with its default, which is
/// read and means nothing; any other value is refused. A settings struct lists its retired keys as
///
///     static constexpr auto retired = std::to_array<RetiredKey>({{"clock", "\"rays\"", "..."}});
struct RetiredKey {
  std::string_view key;
  std::string_view only;  ///< its former default, as JSON: the one value that is allowed
  std::string_view now;   ///< what holds now, as the message says it
};

}  // namespace lacuna
