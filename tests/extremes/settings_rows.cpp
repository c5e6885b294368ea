// Every number of a method's tables at both ends of its range, and beyond them.
#include <fmt/format.h>

#include <algorithm>

#include "jobs/spec/job_json.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

std::string needs_numbers(const Method& method) {
  return with_numbers_at(method, End::lowest).empty() &&
                 with_numbers_at(method, End::highest).empty()
             ? "has no number in its tables"
             : "";
}

Row at(End end, const std::string& name) {
  return {
      name,
      [=](Stage& stage, const Method& method, Check& check) {
        const Furnace f{.albedo = 0.5};
        const std::string& scene = stage.scene("furnace", [&] { return furnace(f); });
        for (const Method& m : with_numbers_at(method, end)) {
          check.or_refused([&] { check_furnace(stage.render(stage.job(m, scene)), m, f, check); });
        }
      },
      needs_numbers};
}

Row beyond(End end, const std::string& name) {
  return {name,
          [=](Stage& stage, const Method& method, Check& check) {
            for (const Method& m : with_numbers_at(method, end)) {
              const std::string json = write_job(stage.job(m, "any.glb"));
              std::string setting = m.name.substr(method.name.size() + 1);
              setting.resize(setting.find('='));
              std::replace(setting.begin(), setting.end(), '.', '/');  // as in its JSON pointer
              check.refused([&] { parse_job(json); }, setting);
            }
          },
          needs_numbers};
}

}  // namespace

std::vector<Row> settings_rows(const Effort&) {
  return {beyond(End::below, "numbers below their range"),
          at(End::lowest, "numbers at their least"), at(End::highest, "numbers at their most"),
          beyond(End::above, "numbers above their range")};
}

}  // namespace lacuna::extremes
