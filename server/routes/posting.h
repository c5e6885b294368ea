#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "base/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {

/// The Idempotency-Key of a request that creates something, and the hash of its body.
struct PostKey {
  std::optional<std::string> name;  ///< none: no key
  std::string body_hash;
};

/// Throws HttpError 400 if the header is not a valid key.
PostKey key_of(const Request& request, const std::string& body);

/// 201 with the description of the object created at `place`; 200 for a replay.
Response created(bool replayed, const std::string& place, const OrderedJson& description);

/// Throws HttpError 422: the key belongs to this job or sweep (`noun`), created from another body.
[[noreturn]] void refuse_key(const std::string& noun, const std::string& id);

/// Whether `known`, created with the same key, came from the same request. Throws as refuse_key().
template <class Entry>
bool is_replay(const std::optional<Entry>& known, const PostKey& key, const char* noun) {
  if (!known) return false;
  if (known->body_hash != key.body_hash) refuse_key(noun, known->id);
  return true;
}

}  // namespace lacuna
