#include "server/routes/posting.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/http/conditional.h"

namespace lacuna {

PostKey key_of(const Request& request, const std::string& body) {
  constexpr std::size_t longest = 128;
  auto key = request.header("idempotency-key");
  const auto is_printable = [](unsigned char c) { return c > 0x20 && c < 0x7f; };
  if (key && (key->empty() || key->size() > longest ||
              !std::all_of(key->begin(), key->end(), is_printable))) {
    throw HttpError(400, "Header Idempotency-Key takes 1 to 128 printable characters, no spaces.");
  }
  if (!key) return {};
  const XXH128_hash_t h = XXH3_128bits(body.data(), body.size());
  return {std::move(key), fmt::format("{:016x}{:016x}", h.high64, h.low64)};
}

void refuse_key(const std::string& noun, const std::string& id) {
  throw HttpError(
      422, fmt::format("This Idempotency-Key belongs to {} {}, which was posted with another body.",
                       noun, id));
}

Response created(bool replayed, const std::string& place, const OrderedJson& description) {
  Response response = json_response(replayed ? 200 : 201, description);
  if (replayed) response.headers.emplace_back("Idempotent-Replayed", "true");
  response.headers.emplace_back("Location", place);
  return response;
}

}  // namespace lacuna
