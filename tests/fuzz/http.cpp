#include <cctype>
#include <fstream>
#include <string>
#include <string_view>

#include "jobs/spec/job_json.h"
#include "server/http/access.h"
#include "server/http/conditional.h"
#include "server/http/file_response.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

// A request, as the HTTP library hands it over: what the service makes of its head, address and
// body ends in a response, or in a refusal with a status of its own.

namespace lacuna::fuzz {
namespace {

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line.substr(0, line.find_last_not_of('\r') + 1);
}

/// "METHOD TARGET", lines of headers, an empty line, and a body; gives the target.
std::string_view read_request(std::string_view text, Request& request) {
  std::string_view line = take_line(text);
  request.method = line.substr(0, line.find(' '));
  line.remove_prefix(std::min(line.size(), request.method.size() + 1));
  const std::string_view target = line.substr(0, line.find(' '));
  request.path = target.substr(0, target.find('?'));
  for (line = take_line(text); !line.empty(); line = take_line(text)) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    std::string name(line.substr(0, colon));
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    std::string_view value = line.substr(std::min(colon + 1, line.size()));
    value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
    request.headers.emplace(std::move(name), value);
  }
  if (const auto range = request.headers.find("range"); range != request.headers.end()) {
    const auto number = [&](std::size_t i) {  // -1: none
      return i < range->second.size() ? static_cast<unsigned char>(range->second[i]) - 1 : -1;
    };
    request.range = ByteRange{number(0), number(1)};
  }
  request.read_body = [text](std::size_t max_bytes) {
    return std::string(text.substr(0, max_bytes));
  };
  return target;
}

/// The service's own parts, but without jobs: what a request can reach, and nothing that lasts.
class Site {
 public:
  Site() { std::ofstream(folder_.dir() / "index.html") << std::string(100, 'x'); }

  Response answer(const Request& request, std::string_view target) {
    check_framing(request);
    access_.admit(request);
    const std::size_t mark = std::min(target.find('?'), target.size());
    const Query query(target.substr(std::min(mark + 1, target.size())));
    if (request.path.starts_with("/api/jobs")) {
      wanted_revision(request);
      try {
        return with_tag(request, json_response(200, write_job(parse_job(request.read_body(4096)))));
      } catch (const BadJob& bad) {
        throw HttpError(400, "The job is not valid.", bad.problems());
      }
    }
    if (request.path == "/log") {
      return log_response(folder_.dir(), "index.html", query.integer("offset", 0).value_or(0));
    }
    return file_response(request, folder_.dir(), "index.html", "text/html");
  }

 private:
  Folder folder_;
  Access access_{"127.0.0.1", {}, [](const std::string& path) { return path == "/"; }};
};

void check(const Response& response) {
  expect(response.status >= 200 && response.status < 600, "a status is final");
  for (const auto& [name, value] : response.headers) {
    for (const unsigned char c : value) expect(c >= ' ' && c != 0x7f, "headers hold no control");
  }
  if (!response.file) return;
  expect(response.file->offset >= 0 && response.file->length > 0, "a part of a file has bytes");
  expect(response.file->offset + response.file->length <= 100, "which the file has");
}

}  // namespace
}  // namespace lacuna::fuzz

LACUNA_FUZZ_TARGET(http) {
  using namespace lacuna;
  static fuzz::Site site;
  Request request;
  const std::string_view target =
      fuzz::read_request({reinterpret_cast<const char*>(data), size}, request);
  try {
    fuzz::check(site.answer(request, target));
  } catch (const HttpError& error) {
    fuzz::expect(error.status() >= 400 && error.status() < 500, "a refusal blames the client");
    fuzz::check(problem_response(error, "/"));
  }
  return 0;
}
