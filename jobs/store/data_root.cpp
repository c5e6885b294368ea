#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "jobs/spec/byte_size.h"
#include "jobs/store/job_folder.h"

namespace lacuna {
namespace {

/// The value of an environment variable; empty if it is not set.
std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

}  // namespace

DataRoot DataRoot::from_environment() {
  const std::string named = variable("LACUNA_DATA");
  return at(named.empty() ? "lacuna-data" : named);
}

DataRoot DataRoot::at(const std::filesystem::path& dir) {
  DataRoot data{std::filesystem::absolute(dir)};
  if (const std::string folder = variable("LACUNA_CACHE"); !folder.empty()) {
    data.cache_folder = std::filesystem::absolute(folder);
  }
  if (const std::string limit = variable("LACUNA_CACHE_LIMIT"); !limit.empty()) {
    try {
      data.cache_limit = parse_byte_size(limit);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(fmt::format("LACUNA_CACHE_LIMIT: {}", e.what()));
    }
  }
  return data;
}

}  // namespace lacuna
