#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "analysis/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {

/// Handles POST of JSON that creates an object (a job or a sweep, by the derived class): one for
/// each request, but only one for each Idempotency-Key, even after a restart.
class Posting {
 public:
  virtual ~Posting() = default;
  Posting(const Posting&) = delete;
  Posting& operator=(const Posting&) = delete;

  /// 201 with the thing, once it is on disk; 200 with the one that the same Idempotency-Key and
  /// body have made before. Throws HttpError: 400, 415, 422 (the key stands for another body), 503
  /// (the key may be that of a thing that cannot be read now), and what make() throws.
  Response post(const Request& request);

 protected:
  /// Of the request; both empty: it has none.
  struct Key {
    std::string name, body_hash;
  };
  /// `noun`: "job", for messages; `place`: "/api/jobs/", where things are found by their id.
  Posting(std::string noun, std::string place, std::size_t max_bytes)
      : noun_(std::move(noun)), place_(std::move(place)), max_bytes_(max_bytes) {}

  std::string read_body(const Request& request) const;
  /// Stores the thing with its key, synced; gives its id.
  virtual std::string make(const std::string& body, const Key& key) = 0;
  struct StoredKeys {
    std::map<std::string, std::string> ids;  ///< by their keys
    std::string unread;  ///< why the key of some thing is not known now; empty: all are
  };
  /// The keys of all things that are stored.
  virtual StoredKeys stored_keys() const = 0;
  /// Of the key of a stored thing; nothing: it is not there any more.
  virtual std::optional<std::string> body_hash(const std::string& id) const = 0;
  virtual OrderedJson describe_made(const std::string& id) const = 0;

 private:
  Response answer(int status, const std::string& id) const;

  const std::string noun_, place_;
  const std::size_t max_bytes_;
  std::mutex mutex_;  // held while a thing with a key is made: the same key twice at once is one
  std::optional<StoredKeys> keys_;  // once read
};

}  // namespace lacuna
