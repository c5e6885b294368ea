"""Faults in the service."""

from fault import Fault

UNIT = ("test_server",)
REQUESTS = ("tests/server/requests.test.mjs",)
JOBS = ("tests/server/jobs.test.mjs",)
EVENTS = ("tests/server/events.test.mjs",)
SWEEPS = ("tests/server/sweeps.test.mjs",)

ARCHIVES = ("test_server",)

FAULTS = [
    Fault("an archive leaves its folder", "server/routes/scene_archive.cpp",
          'if (part.empty() || part == "." || part == "..")', 'if (part.empty() || part == ".")', ARCHIVES),
    Fault("an archive has links", "server/routes/scene_archive.cpp",
          "type == 0 || S_ISREG(type);", "type == 0 || S_ISREG(type) || S_ISLNK(type);", ARCHIVES),
    Fault("a folder with more files is the same", "server/routes/scene_uploads.cpp",
          "}) == static_cast<std::ptrdiff_t>(files);", "}) >= static_cast<std::ptrdiff_t>(files);", ARCHIVES),
    # Requests and responses.
    Fault("If-Match is not looked at before a cancel", "server/routes/job_routes.cpp",
          "queue_.cancel(id, wanted_revision(request));", 'queue_.cancel(id, "");', REQUESTS),
    Fault("If-Match is not looked at before a removal", "server/routes/job_routes.cpp",
          "queue_.remove(id, wanted_revision(request));",
          "queue_.remove(id, wanted_revision(request).substr(0, 0));", REQUESTS),
    Fault("checkpoints can be downloaded", "server/routes/job_routes.cpp",
          "if (info.served && info.name == name) {", "if (info.name == name) {", JOBS),
    Fault("a range ends before its last byte", "server/http/file_response.cpp",
          "response.file->length = last - first + 1;", "response.file->length = last - first;", JOBS),
    Fault("a range goes beyond the end of its file", "server/http/file_response.cpp",
          "std::min(range.last, size - 1)", "range.last", JOBS),
    Fault("If-Range is not compared", "server/http/file_response.cpp",
          "(!if_range || *if_range == tag)", "(!if_range || !if_range->empty())", JOBS),
    Fault("the next offset of a log is its end", "server/http/file_response.cpp",
          'fmt::format("{}", offset + length)', 'fmt::format("{}", size)', JOBS),
    Fault("chunks are limited one by one", "server/http/http.cpp",
          "if (size > max_bytes - total) throw too_large;", "if (size > max_bytes) throw too_large;", UNIT),
    Fault("a plus in a query is no blank", "server/http/query.cpp",
          "text += sent[i] == '+' ? ' ' : sent[i];", "text += sent[i];", UNIT),
    Fault("numbers in a query have no lower limit", "server/http/query.cpp",
          "value < min || value > max", "value > max || min > max", UNIT),
    # Access.
    Fault("pages of other sites may send PATCH and DELETE", "server/http/guard.cpp",
          "if (!is_safe(request) && !own) {", 'if (request.method == "POST" && !own) {', UNIT),
    Fault("names of hosts depend on their case", "server/http/guard.cpp",
          "HostPort result{lower_case(std::string(text.substr(0, colon))), {}};",
          "HostPort result{std::string(text.substr(0, colon)), {}};", UNIT),
    Fault("scripts can read the session's cookie", "server/http/access.cpp",
          "Path=/; HttpOnly; SameSite=Strict", "Path=/; SameSite=Strict", ("tests/server/access.test.mjs",)),
    Fault("a token's beginning is enough", "server/http/token.cpp",
          "volatile std::size_t different = shown.size() ^ secret_.size();",
          "volatile std::size_t different = shown.size() > secret_.size();", UNIT),
    Fault("the newest session is forgotten for the next", "server/http/token.cpp",
          "ids_.pop_front();", "ids_.pop_back();", UNIT),
    Fault("wrong tokens are not limited", "server/http/access.cpp",
          "tries_ -= 1;", "tries_ -= 0;", UNIT),
    # Events and metrics.
    Fault("there is an event stream too many", "server/routes/events.cpp",
          "if (taken_->fetch_add(1) < max_event_streams) return;",
          "if (taken_->fetch_add(1) <= max_event_streams) return;", EVENTS),
    Fault("a stream whose end was seen stays open", "server/routes/events.cpp",
          "over_ = !news && (!entry || entry->over());", "over_ = !news && !entry;", EVENTS),
    Fault("a line feed breaks a metric", "server/http/prometheus.cpp",
          'result += "\\\\n";', "result += c;", UNIT),
    Fault("buckets of a histogram are not summed", "server/http/prometheus.cpp",
          "total += counts[i];", "total = counts[i];", UNIT),
    # What is kept.
    Fault("the age of a job is that of its post", "server/keeper/retention.cpp",
          "std::max(state.finished, state.created) < too_old", "state.created < too_old", UNIT),
    Fault("a job more than allowed is kept", "server/keeper/retention.cpp",
          "? removable.size() - settings.keep_jobs", "? removable.size() - settings.keep_jobs - 1", UNIT),
    Fault("an upload of the same size is the same scene", "server/routes/scene_uploads.cpp",
          "!std::equal(from_a.begin(), from_a.begin() + a.gcount(), from_b.begin())", "a.gcount() < 0", UNIT),
    Fault("the cache is listed smallest first", "server/routes/cache_listing.cpp",
          "return a.bytes > b.bytes;", "return a.bytes < b.bytes;", JOBS),
    Fault("baselines of cells are counted from 0", "server/routes/sweep_catalogue.cpp",
          "OrderedJson(*cell.baseline + 1)", "OrderedJson(*cell.baseline)", SWEEPS),
    Fault("sweeps fill the queue for all others", "server/keeper/sweep_keeper.cpp",
          "queue_.room() - std::min(queue_.room(), kept_free_)", "queue_.room()",
          ("tests/server/sweep_runs.test.mjs",)),
    Fault("a figure reads what its client names", "server/routes/tool_routes.cpp",
          'run({"figure", "figure.json", "--ids", "--out"', 'run({"figure", "figure.json", "--out"',
          ("tests/server/figures.test.mjs",)),
]
