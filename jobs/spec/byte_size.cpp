#include "jobs/spec/byte_size.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <stdexcept>

namespace lacuna {
namespace {

constexpr std::string_view units = "KMGT";

}  // namespace

std::uint64_t parse_byte_size(std::string_view text) {
  const auto refuse = [&] {
    throw std::invalid_argument(
        fmt::format("found \"{}\"; allowed: an integer number of bytes, or of K, M, G or T (powers "
                    "of 1024), as in 4G, below 2^63 bytes",
                    text));
  };
  std::string_view digits = text;
  unsigned shift = 0;
  if (!text.empty() && units.find(text.back()) != std::string_view::npos) {
    shift = 10 * static_cast<unsigned>(units.find(text.back()) + 1);
    digits.remove_suffix(1);
  }
  std::uint64_t count = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, count);
  if (digits.empty() || error != std::errc() || stop != end) refuse();
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (count > most >> shift) refuse();
  return count << shift;
}

std::string byte_size_text(std::uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  auto value = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  for (; value >= 1024 && unit + 1 < units.size(); ++unit) value /= 1024;
  return fmt::format("{:.1f} {}iB", value, units[unit]);
}

}  // namespace lacuna
