#include "jobs/queue/find_program.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace lacuna {
namespace fs = std::filesystem;

fs::path find_program(const std::string& name) {
  const auto is_one = [](const fs::path& file) { return ::access(file.c_str(), X_OK) == 0; };
  if (name.find('/') != std::string::npos) {
    return is_one(name) ? fs::absolute(name) : fs::path{};
  }
  const char* set = std::getenv("PATH");
  std::string_view path = set == nullptr ? "" : set;
  while (!path.empty()) {
    const auto end = std::min(path.find(':'), path.size());
    fs::path file = fs::path(path.substr(0, end)) / name;
    if (file.is_absolute() && is_one(file)) return file;
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return {};
}

}  // namespace lacuna
