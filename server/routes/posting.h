#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "base/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {

/// The Idempotency-Key of a request that creates something, and what it stands for.
struct PostKey {
  std::optional<std::string> name;  ///< nothing: it has none
  std::string body_hash;
};

/// Throws HttpError 400 if the header is no key.
PostKey key_of(const Request& request, const std::string& body);

/// 201 with the description of what was created at `place`; 200 for a replay.
Response created(bool replayed, const std::string& place, const OrderedJson& description);

/// Throws HttpError 422: the key belongs to this job or sweep (`noun`), made of another body.
[[noreturn]] void refuse_key(const std::string& noun, const std::string& id);

/// Whether `known`, what the key has made before, was made by the same request. Throws as
/// refuse_key().
template <class Entry>
bool is_replay(const std::optional<Entry>& known, const PostKey& key, const char* noun) {
  if (!known) return false;
  if (known->body_hash != key.body_hash) refuse_key(noun, known->id);
  return true;
}

}  // namespace lacuna
