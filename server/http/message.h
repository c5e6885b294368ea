#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/storage/file_handle.h"
#include "jobs/spec/problems.h"
#include "server/http/query.h"

namespace lacuna {

/// Names are in lower case; values have no blanks around them, and the HTTP library has decoded
/// each %XX in them.
using Headers = std::multimap<std::string, std::string>;

/// The text with ASCII letters in lower case.
std::string lower_case(std::string text);

/// First and last byte of a range as a client sends it: `last` -1 is the end; with `first` -1,
/// `last` is the number of bytes before the end (RFC 9110, section 14.1.2).
struct ByteRange {
  std::int64_t first = -1, last = -1;
};

/// A request, as passed to handlers.
struct Request {
  std::string method;
  std::string path;  ///< as sent, without the query and not decoded, which no name here needs
  Query query;       ///< decoded
  Headers headers;
  std::optional<ByteRange> range;  ///< header Range, if it is a single range

  /// Reads the body, at most `max_bytes`; throws HttpError 413 if it is larger, 400 if it ends
  /// early, pauses too long, or is malformed. A body can be read once.
  std::function<std::string(std::size_t max_bytes)> read_body;
  /// The same for a large body, written to a file at its present position; returns the number of
  /// bytes. Also throws std::system_error if the file cannot be written.
  std::function<std::uint64_t(int fd, std::uint64_t max_bytes)> read_body_to;

  /// The value of a header, by its name in lower case; none if it is absent. Throws HttpError if it
  /// is repeated.
  std::optional<std::string> header(const std::string& name) const;
};

/// Whether the request has a body.
bool announces_body(const Request& request);

/// The media type of the body, in lower case and without parameters: "application/json"; empty if
/// it has none.
std::string media_type(const Request& request);

/// A part of an open file.
struct FilePart {
  FileHandle file;
  std::int64_t offset = 0;
  std::int64_t length = 0;
};

/// A response: a text, a part of a file, or a stream of texts.
struct Response {
  int status = 200;
  std::string content_type;
  std::vector<std::pair<std::string, std::string>> headers;  ///< never text from a client
  std::string body;
  std::optional<FilePart> file;
  /// Called repeatedly: returns the next text (empty: nothing new after a short wait), or none at
  /// the end.
  std::function<std::optional<std::string>()> stream;
};

/// The title of a status: "Not found".
const char* status_title(int status);

/// A refusal of a request: becomes an application/problem+json response.
class HttpError : public std::runtime_error {
 public:
  HttpError(int status, const std::string& detail, std::vector<Problem> errors = {})
      : std::runtime_error(detail), status_(status), errors_(std::move(errors)) {}
  int status() const { return status_; }
  const std::vector<Problem>& errors() const { return errors_; }
  /// Adds a header to the response, such as Allow.
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

/// The error for a file that could not be written or read: 503 if no descriptor was left, else 507.
/// `what`: the beginning of the sentence; the response names no file.
HttpError storage_error(const std::system_error& error, const std::string& what);

/// The application/problem+json response (RFC 9457) to a request for `path`.
Response problem_response(const HttpError& error, const std::string& path);

}  // namespace lacuna
