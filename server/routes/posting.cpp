#include "server/routes/posting.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/http/conditional.h"
#include "server/routes/json_body.h"

namespace lacuna {
namespace {

std::string hash128(const std::string& text) {
  const XXH128_hash_t h = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

/// The header's value; throws HttpError 400 if it is no key.
std::optional<std::string> key_of(const Request& request) {
  constexpr std::size_t longest = 128;
  auto key = request.header("idempotency-key");
  const auto is_printable = [](unsigned char c) { return c > 0x20 && c < 0x7f; };
  if (key && (key->empty() || key->size() > longest ||
              !std::all_of(key->begin(), key->end(), is_printable))) {
    throw HttpError(400, "Header Idempotency-Key takes 1 to 128 printable characters, no spaces.");
  }
  return key;
}

}  // namespace

std::string Posting::read_body(const Request& request) const {
  return read_json_body(request, max_bytes_);
}

Response Posting::post(const Request& request) {
  const auto key = key_of(request);
  const std::string body = read_body(request);
  if (!key) return answer(201, make(body, {}));

  const std::string hash = hash128(body);
  const std::lock_guard lock(mutex_);
  if (!keys_ || !keys_->unread.empty()) keys_ = stored_keys();
  if (const auto known = keys_->ids.find(*key); known != keys_->ids.end()) {
    const std::string& id = known->second;
    if (const auto made_of = body_hash(id)) {
      if (*made_of == hash) {
        Response response = answer(200, id);
        response.headers.emplace_back("Idempotent-Replayed", "true");
        return response;
      }
      throw HttpError(422, fmt::format("This Idempotency-Key belongs to {} {}, which was posted "
                                       "with another body.",
                                       noun_, id));
    }
  }
  if (!keys_->unread.empty()) {
    throw HttpError(503,
                    fmt::format("This Idempotency-Key may be known already: {}.", keys_->unread))
        .with("Retry-After", "1");
  }
  const std::string id = make(body, {*key, hash});
  keys_->ids[*key] = id;
  return answer(201, id);
}

Response Posting::answer(int status, const std::string& id) const {
  Response response = json_response(status, describe_made(id));
  response.headers.emplace_back("Location", place_ + id);
  return response;
}

}  // namespace lacuna
