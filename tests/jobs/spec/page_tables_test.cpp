#include "jobs/spec/page_tables.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "jobs/spec/identity.h"

namespace lacuna {
namespace {

TEST(PageTables, HaveEveryMetricOfTheTable) {
  const OrderedJson metrics = page_tables()["metrics"];
  ASSERT_EQ(metrics.size(), error_metrics.size());
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    EXPECT_EQ(metrics[i]["key"].get<std::string>(), error_metrics[i].name);
    EXPECT_EQ(metrics[i]["label"].get<std::string>(), error_metrics[i].label);
  }
  EXPECT_EQ(page_tables()["inTheLight"], OrderedJson::array({"/integrator/max_depth"}));
  EXPECT_EQ(page_tables()["notInAReference"], OrderedJson(not_in_a_reference));
}

TEST(PageTables, TheModuleExportsEach) {
  const std::string text = page_tables_module();
  for (const char* name : {"metrics", "notInAReference", "inTheLight"}) {
    EXPECT_NE(text.find("\nexport const " + std::string(name) + " = ["), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace lacuna
