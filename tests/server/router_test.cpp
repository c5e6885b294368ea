#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "server/http/http.h"
#include "tests/server/loopback.h"

namespace lacuna {
namespace {

using Type = QueryParameter::Type;

Router make_router() {
  Router router;
  const auto handler = [](const Request& request, const Router::Parts& parts) {
    Response response;
    response.body = request.method;
    for (const auto& part : parts) response.body += " " + part;
    return response;
  };
  router.add("GET", "/jobs",
             {.summary = "All jobs.",
              .query = {{"limit", Type::integer, "How many.", 1, 1000},
                        {"label", Type::text, "Part of a label."},
                        {"all", Type::flag, "Also old ones."}},
              .answers = {{200, "The list."}, {400, "A bad query."}}},
             handler);
  router.add("POST", "/jobs",
             {.body_types = {"application/json"}, .body_schema = R"({"type": "object"})"}, handler);
  router.add("DELETE", "/jobs/{id}/files/{name}", handler);
  return router;
}

TEST(Router, RefusesWhatTheRouteDoesNotKnowBeforeItsHandler) {
  HttpMetrics metrics;
  HttpServer server({.port = 0}, make_router(), metrics);
  server.bind();
  server.start();
  const auto status = [&](const std::string& line) {
    return test::Client(server, test::head(line)).status();
  };
  EXPECT_EQ(status("GET /jobs?limit=1000&label=x&all=1"), 200);
  EXPECT_EQ(status("HEAD /jobs?limit=1"), 200);
  for (const std::string query :
       {"limit=0", "limit=1001", "limit=", "limit=x", "all=2", "lmit=1"}) {
    EXPECT_EQ(status("GET /jobs?" + query), 400) << query;
  }
  EXPECT_EQ(status("POST /jobs?limit=1"), 400);
  EXPECT_EQ(status("DELETE /jobs/a/files/b"), 200);
  EXPECT_EQ(status("DELETE /jobs/a/files/b?x=1"), 400);
  EXPECT_EQ(status("DELETE /jobs//files/b"), 404);
  EXPECT_EQ(status("PATCH /jobs"), 405);
}

TEST(Router, DescribesItself) {
  const auto json = make_router().openapi({{"title", "t"}, {"version", "1"}});
  EXPECT_EQ(json["openapi"], "3.1.0");
  EXPECT_EQ(json["info"]["title"], "t");
  const auto& get = json["paths"]["/jobs"]["get"];
  EXPECT_EQ(get["summary"], "All jobs.");
  ASSERT_EQ(get["parameters"].size(), 3U);
  EXPECT_EQ(get["parameters"][0]["name"], "limit");
  EXPECT_EQ(get["parameters"][0]["schema"],
            parse_own(R"({"type":"integer","minimum":1,"maximum":1000})"));
  EXPECT_EQ(get["responses"]["200"]["description"], "The list.");
  EXPECT_TRUE(get["responses"]["400"]["content"].contains("application/problem+json"));
  EXPECT_FALSE(get.contains("requestBody"));
  const auto& post = json["paths"]["/jobs"]["post"];
  EXPECT_EQ(post["requestBody"]["content"]["application/json"]["schema"]["type"], "object");
  const auto& remove = json["paths"]["/jobs/{id}/files/{name}"]["delete"];
  ASSERT_EQ(remove["parameters"].size(), 2U);
  EXPECT_EQ(remove["parameters"][1]["name"], "name");
  EXPECT_EQ(remove["parameters"][1]["in"], "path");
  EXPECT_TRUE(json["security"].is_array());
  EXPECT_EQ(json["security"].size(), 3U) << json["security"];
}

}  // namespace
}  // namespace lacuna
