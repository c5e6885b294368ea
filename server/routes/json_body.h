#pragma once

#include <optional>
#include <string>

#include "jobs/spec/job_spec.h"
#include "server/http/message.h"

namespace lacuna {

/// The body of a request, which must be application/json. Throws HttpError 415 and the exceptions
/// of read_body().
std::string read_json_body(const Request& request, std::size_t max_bytes);

/// The body of PATCH /api/jobs/ID.
struct JobChange {
  std::optional<int> priority;
  std::optional<bool> held;
};
/// Throws HttpError 400 with the position of every error.
JobChange read_job_change(const Request& request);

/// Its JSON Schema.
std::string job_change_schema();

/// POST /api/jobs/ID/extend: {"budget": ...}. Throws HttpError 400, too.
Budget read_extension(const Request& request);
std::string extension_schema();

}  // namespace lacuna
