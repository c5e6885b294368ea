#include "server/job_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "jobs/spec/problems.h"
#include "server/catalogue.h"
#include "server/conditional.h"
#include "server/file_response.h"
#include "server/json_body.h"
#include "server/log_response.h"

namespace lacuna {
namespace {

/// Runs a change of a job and gives what went wrong its HTTP status.
template <class Change>
void apply(Change&& change) {
  try {
    change();
  } catch (const Changed& error) {
    throw HttpError(412, error.what());
  } catch (const Conflict& error) {
    throw HttpError(409, error.what());
  } catch (const BadJob& bad) {
    throw HttpError(400, "The new budget is not valid.", bad.problems());
  } catch (const std::system_error& error) {
    throw HttpError(507, fmt::format("This could not be stored: {}.", error.code().message()));
  }
}

std::vector<State> states_of(const std::string& text) {
  std::vector<State> states;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view word = std::string_view(text).substr(begin, end - begin);
    const auto& values = EnumTable<State>::values;
    const auto found = std::find_if(values.begin(), values.end(),
                                    [&](const auto& value) { return value.name == word; });
    if (found == values.end()) {
      std::string names;
      for (const auto& value : values)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", value.name);
      throw HttpError(400,
                      fmt::format("Query parameter state: \"{}\" is none of {}.", word, names));
    }
    states.push_back(found->value);
    begin = end + 1;
  }
  return states;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

constexpr std::int64_t max_log_offset = std::int64_t{1} << 50;

}  // namespace

JobRoutes::JobRoutes(DataRoot data, const ScenesRoots& scenes, JobTable& table, Queue& queue)
    : table_(table),
      queue_(queue),
      posting_(std::move(data), scenes, table, queue),
      events_(table) {}

Response JobRoutes::list(const Request& request) {
  JobTable::Query query;
  if (const auto states = request.query.text("state")) query.states = states_of(*states);
  query.words = lower_case(request.query.text("label").value_or(""));
  query.limit = static_cast<std::size_t>(request.query.integer("limit", 1, 1000).value_or(100));
  query.after = request.query.text("cursor").value_or("");
  try {
    return with_tag(request, json_response(200, list_text(table_.list(query))));
  } catch (const std::invalid_argument& error) {
    throw HttpError(400, fmt::format("Query parameter cursor: {}.", error.what()));
  }
}

Response JobRoutes::answer(const Request& request, int status, const std::string& id) {
  const EntryPtr entry = find_job(table_, id);
  return with_tag(request, json_response(status, job_detail(table_, *entry)), entry->revision);
}

Response JobRoutes::detail(const Request& request, const std::string& id) {
  return answer(request, 200, id);
}

Response JobRoutes::change(const Request& request, const std::string& id) {
  find_job(table_, id);
  const auto asked = read_job_change(request);
  apply([&] { queue_.change(id, asked.priority, asked.held, wanted_revision(request)); });
  return answer(request, 200, id);
}

Response JobRoutes::cancel(const Request& request, const std::string& id) {
  find_job(table_, id);
  apply([&] { queue_.cancel(id, wanted_revision(request)); });
  return answer(request, is_terminal(find_job(table_, id)->state.state) ? 200 : 202, id);
}

Response JobRoutes::retry(const Request& request, const std::string& id) {
  find_job(table_, id);
  apply([&] { queue_.retry(id, wanted_revision(request)); });
  return answer(request, 200, id);
}

Response JobRoutes::extend(const Request& request, const std::string& id) {
  find_job(table_, id);
  const Budget budget = read_extension(request);
  apply([&] { queue_.extend(id, budget, wanted_revision(request)); });
  return answer(request, 200, id);
}

Response JobRoutes::remove(const Request& request, const std::string& id) {
  find_job(table_, id);
  apply([&] { queue_.remove(id, wanted_revision(request)); });
  Response response;
  response.status = 204;
  return response;
}

Response JobRoutes::file(const Request& request, const std::string& id, const std::string& name) {
  find_job(table_, id);
  for (const FileInfo& info : job_files()) {
    if (info.served && info.name == name) {
      return file_response(request, table_.folder(id).dir(), name, info.media_type);
    }
  }
  throw HttpError(404, fmt::format("Jobs have no file \"{}\".", name));
}

Response JobRoutes::log(const Request& request, const std::string& id) {
  find_job(table_, id);
  return log_response(table_.folder(id).dir(), "log.txt",
                      request.query.integer("offset", 0, max_log_offset).value_or(0));
}

void JobRoutes::add_to(Router& router) {
  using Parts = Router::Parts;
  const auto with_id = [this](Response (JobRoutes::*handler)(const Request&, const std::string&)) {
    return [this, handler](const Request& request, const Parts& parts) {
      return (this->*handler)(request, parts[0]);
    };
  };
  const auto stream = [](Events::Stream texts) {
    Response response;
    response.content_type = "text/event-stream";
    response.headers = {{"Cache-Control", "no-store"}};
    response.stream = std::move(texts);
    return response;
  };
  router.add("GET", "/api/jobs",
             [this](const Request& request, const Parts&) { return list(request); });
  router.add("POST", "/api/jobs", [this](const Request& request, const Parts&) {
    const bool dry = request.query.integer("dry_run", 0, 1).value_or(0) == 1;
    return dry ? posting_.dry_run(request) : posting_.post(request);
  });
  router.add("GET", "/api/jobs/{}", with_id(&JobRoutes::detail));
  router.add("PATCH", "/api/jobs/{}", with_id(&JobRoutes::change));
  router.add("DELETE", "/api/jobs/{}", with_id(&JobRoutes::remove));
  router.add("POST", "/api/jobs/{}/cancel", with_id(&JobRoutes::cancel));
  router.add("POST", "/api/jobs/{}/retry", with_id(&JobRoutes::retry));
  router.add("POST", "/api/jobs/{}/extend", with_id(&JobRoutes::extend));
  router.add("GET", "/api/jobs/{}/log", with_id(&JobRoutes::log));
  router.add(
      "GET", "/api/jobs/{}/events", [this, stream](const Request& request, const Parts& parts) {
        return stream(events_.job(find_job(table_, parts[0])->id, request.header("last-event-id")));
      });
  router.add("GET", "/api/jobs/{}/files/{}", [this](const Request& request, const Parts& parts) {
    return file(request, parts[0], parts[1]);
  });
  router.add("GET", "/api/events", [this, stream](const Request& request, const Parts&) {
    const auto last = request.header("last-event-id");
    return stream(events_.all(last ? last : request.query.text("after")));
  });
}

}  // namespace lacuna
