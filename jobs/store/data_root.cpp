#include <cstdlib>

#include "jobs/store/job_folder.h"

namespace lacuna {

DataRoot DataRoot::from_environment() {
  const char* named = std::getenv("LACUNA_DATA");
  const bool is_set = named != nullptr && *named != '\0';
  return {std::filesystem::absolute(is_set ? named : "lacuna-data")};
}

}  // namespace lacuna
