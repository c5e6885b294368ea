#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/file_handle.h"
#include "jobs/spec/problems.h"

namespace lacuna {

/// A request as the routes see it: bounded and well formed.
struct Request {
  std::string method;
  std::string path;  ///< as sent, without the query; nothing is decoded: no name here needs it
  std::multimap<std::string, std::string> headers;  ///< names in lower case
  std::map<std::string, std::string> query;  ///< decoded parameters

  std::optional<std::string> parameter(const std::string& name) const;
  std::optional<std::int64_t> integer(const std::string& name, std::int64_t min, std::int64_t max) const;

  /// Reads the body, at most `max_bytes` of it; throws HttpError: 413 if it is larger, 415 if it is
  /// encoded, 400 if its framing is wrong, 408 if it comes too slowly.
  std::function<std::string(std::size_t max_bytes)> read_body;

  /// The value of a header that may stand only once; nothing if it is absent. Throws HttpError.
  std::optional<std::string> header(const std::string& lower_case_name) const;
};

/// A part of an open file.
struct FilePart {
  FileHandle file;
  std::int64_t offset = 0;
  std::int64_t length = 0;
};

/// What goes back: one of a text, a part of a file, or a stream of texts.
struct Response {
  int status = 200;
  std::string content_type;
  std::vector<std::pair<std::string, std::string>> headers;  ///< never anything a client sent
  std::string body;
  std::optional<FilePart> file;
  /// Called again and again: gives the next text (empty: nothing new, after a short wait), or
  /// nothing at the end.
  std::function<std::optional<std::string>()> stream;
};

/// A request that is refused: becomes an application/problem+json answer.
class HttpError : public std::runtime_error {
 public:
  HttpError(int status, const std::string& detail, std::vector<Problem> errors = {})
      : std::runtime_error(detail), status_(status), errors_(std::move(errors)) {}
  int status() const { return status_; }
  const std::vector<Problem>& errors() const { return errors_; }
  /// One more header of the answer, such as Allow.
  HttpError& with(std::string name, std::string value) {
    headers_.emplace_back(std::move(name), std::move(value));
    return *this;
  }
  const std::vector<std::pair<std::string, std::string>>& headers() const { return headers_; }

 private:
  int status_;
  std::vector<Problem> errors_;
  std::vector<std::pair<std::string, std::string>> headers_;
};

/// The application/problem+json answer (RFC 9457) to a request for `path`.
Response problem_response(const HttpError& error, const std::string& path);

}  // namespace lacuna
