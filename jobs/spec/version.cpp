#include "jobs/spec/version.h"

namespace lacuna {

std::string version() { return LACUNA_VERSION; }

}  // namespace lacuna
