#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "analysis/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {

/// Makes what is posted as JSON: a thing for each request, but one for each Idempotency-Key, also
/// after a restart. What the thing is, derived classes say.
class Posting {
 public:
  virtual ~Posting() = default;
  Posting(const Posting&) = delete;
  Posting& operator=(const Posting&) = delete;

  /// 201 with the thing, once it is on disk; 200 with the one that the same Idempotency-Key and
  /// body have made before. Throws HttpError: 400, 415, 422 (the key stands for another body), and
  /// what make() throws.
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
  /// The keys of all things that are stored, and their ids.
  virtual std::map<std::string, std::string> stored_keys() const = 0;
  /// Of the key of a stored thing; nothing: it is not there any more.
  virtual std::optional<std::string> body_hash(const std::string& id) const = 0;
  virtual OrderedJson describe_made(const std::string& id) const = 0;

 private:
  Response answer(int status, const std::string& id) const;

  const std::string noun_, place_;
  const std::size_t max_bytes_;
  std::mutex mutex_;  // held while a thing with a key is made: the same key twice at once is one
  std::optional<std::map<std::string, std::string>> keys_;  // Idempotency-Key -> id; once read
};

}  // namespace lacuna
