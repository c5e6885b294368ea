#include "server/json_body.h"

#include <algorithm>

#include "jobs/spec/described_json.h"
#include "jobs/store/control.h"

namespace lacuna {

template <class V>
void describe(V& v, JobChange& s) {
  v("priority", s.priority,
    {.doc = "higher is rendered earlier", .min = -max_priority, .max = max_priority});
  v("held", s.held, {.doc = "true: it does not start, or go on, until this is false"});
}

namespace {

struct Extension {
  Budget budget;
};
template <class V>
void describe(V& v, Extension& s) {
  v("budget", s.budget, {.doc = "the whole new budget", .required = true});
}

template <Described T>
T read_settings_body(const Request& request, const char* what) {
  constexpr DocumentLimits limits{64 << 10, 8};
  const std::string body = read_json_body(request, limits.max_bytes);
  try {
    return read_document<T>(body, limits);
  } catch (const BadJob& bad) {
    throw HttpError(400, std::string(what) + " is not valid.", bad.problems());
  }
}

/// "application/json; charset=utf-8" and the like.
bool is_json(std::string type) {
  type = type.substr(0, type.find(';'));
  type.erase(type.find_last_not_of(" \t") + 1);
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return type == "application/json";
}

}  // namespace

std::string read_json_body(const Request& request, std::size_t max_bytes) {
  if (!is_json(request.header("content-type").value_or(""))) {
    throw HttpError(415, "This takes a body with Content-Type: application/json.");
  }
  return request.read_body(max_bytes);
}

JobChange read_job_change(const Request& request) {
  return read_settings_body<JobChange>(request, "The change");
}

Budget read_extension(const Request& request) {
  return read_settings_body<Extension>(request, "The extension").budget;
}

}  // namespace lacuna
