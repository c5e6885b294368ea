#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

/// The known word that `word` is most likely a misspelling of: the smallest edit distance
/// (insertions, deletions, substitutions, swaps of neighbours), at most a third of its length.
std::optional<std::string_view> nearest(std::string_view word,
                                        const std::vector<std::string_view>& known);

/// `; did you mean "resolution"?`, or nothing.
std::string nearest_hint(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace lacuna
