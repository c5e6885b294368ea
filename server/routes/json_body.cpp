#include "server/routes/json_body.h"

#include "jobs/spec/described_json.h"
#include "jobs/spec/type_tree.h"
#include "jobs/store/state.h"

namespace lacuna {

template <class V>
void describe(V& v, JobChange& s) {
  v("priority", s.priority,
    {.doc = "higher is rendered earlier", .min = -max_priority, .max = max_priority});
  v("held", s.held, {.doc = "true: it does not start or continue until this is false"});
}

namespace {

struct Extension {
  Budget budget;
};
template <class V>
void describe(V& v, Extension& s) {
  v("budget", s.budget, {.doc = "the new budget, which replaces the old one", .required = true});
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

}  // namespace

std::string read_json_body(const Request& request, std::size_t max_bytes) {
  if (media_type(request) != "application/json") {
    throw HttpError(415, "The body must have Content-Type: application/json.");
  }
  return request.read_body(max_bytes);
}

std::string job_change_schema() { return schema_text(TypeReader::type_of(JobChange{}, Field{})); }

std::string extension_schema() { return schema_text(TypeReader::type_of(Extension{}, Field{})); }

JobChange read_job_change(const Request& request) {
  return read_settings_body<JobChange>(request, "The change");
}

Budget read_extension(const Request& request) {
  return read_settings_body<Extension>(request, "The extension").budget;
}

}  // namespace lacuna
