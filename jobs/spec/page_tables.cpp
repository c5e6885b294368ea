#include "jobs/spec/page_tables.h"

#include <fmt/format.h>

#include "jobs/spec/reference_spec.h"

namespace lacuna {
namespace {

OrderedJson metrics_json() {
  OrderedJson list = OrderedJson::array();
  for (const ErrorMetricRow& m : error_metrics) {
    list.push_back({{"key", m.name},
                    {"label", m.label},
                    {"unit", m.unit},
                    {"slope", m.squared ? -1.0 : -0.5},
                    {"reference", needs_reference(m.value)}});
  }
  return list;
}

OrderedJson light_pointers() {
  OrderedJson lengths = ObjectWriter::value_of(LightLengths{});
  for (const std::string_view key : not_in_the_light) lengths.erase(std::string(key));
  OrderedJson pointers = OrderedJson::array();
  for (const auto& [key, value] : lengths.items()) pointers.push_back("/integrator/" + key);
  return pointers;
}

}  // namespace

OrderedJson page_tables() {
  return {{"metrics", metrics_json()},
          {"notInAReference", not_in_a_reference},
          {"inTheLight", light_pointers()}};
}

std::string page_tables_module() {
  std::string text = "// Tables of the job file, made by Lacuna.\n";
  const OrderedJson tables = page_tables();
  for (const auto& [name, table] : tables.items()) {
    text += fmt::format("export const {} = {};\n", name, json_text(table));
  }
  return text;
}

}  // namespace lacuna
