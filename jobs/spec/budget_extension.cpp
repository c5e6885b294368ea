#include "jobs/spec/budget_extension.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string_view>

#include "base/json/limits.h"

namespace lacuna {
namespace {

class Comparison {
 public:
  template <class T>
  void limit(std::string_view key, const std::optional<T>& old, const std::optional<T>& larger) {
    if (!old) return;
    grows_ = grows_ || !larger || *larger > *old;
    if (larger && *larger < *old) {
      refuse(key, static_cast<double>(*larger), "at least", static_cast<double>(*old));
    }
  }

  void error(const std::optional<ErrorTarget>& old, const std::optional<ErrorTarget>& larger) {
    if (!old) return;
    grows_ = grows_ || !larger || larger->target < old->target;
    if (!larger) return;
    if (larger->metric != old->metric) {
      add("error/metric", fmt::format("found \"{}\"; allowed: \"{}\" as before, or no error target",
                                      enum_name(larger->metric), enum_name(old->metric)));
    } else if (larger->target > old->target) {
      refuse("error/target", larger->target, "at most", old->target);
    }
  }

  std::vector<Problem> take() {
    if (!grows_ && problems_.empty()) {
      problems_.push_back({"/budget", "no limit is larger than before; allowed: a larger budget"});
    }
    return std::move(problems_);
  }

 private:
  void refuse(std::string_view key, double found, std::string_view bound, double old) {
    add(key, fmt::format("found {}; allowed: {} {}, the previous limit, or none",
                         number_text(found), bound, number_text(old)));
  }
  void add(std::string_view key, std::string message) {
    problems_.push_back({fmt::format("/budget/{}", key), std::move(message)});
  }

  std::vector<Problem> problems_;
  bool grows_ = false;
};

}  // namespace

std::vector<Problem> extension_problems(const Budget& old, const Budget& larger) {
  if (!larger.seconds && !larger.cpu_seconds && !larger.iterations && !larger.error) {
    return {{"/budget", "sets no limit; allowed: at least one"}};
  }
  Comparison compare;
  compare.limit("seconds", old.seconds, larger.seconds);
  compare.limit("cpu_seconds", old.cpu_seconds, larger.cpu_seconds);
  compare.limit("iterations", old.iterations, larger.iterations);
  compare.error(old.error, larger.error);
  return compare.take();
}

}  // namespace lacuna
