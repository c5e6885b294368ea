#pragma once

#include <string_view>

namespace lacuna {

/// A key of an earlier version. Stored jobs contain it with its default, which is accepted and
/// ignored; other values are refused. A settings struct lists its retired keys as
///
///     static constexpr auto retired = std::to_array<RetiredKey>({{"clock", "\"rays\"", "..."}});
struct RetiredKey {
  std::string_view key;
  std::string_view only;  ///< its former default, as JSON: the one value that is allowed
  std::string_view now;   ///< the present behaviour, for the message
};

}  // namespace lacuna
