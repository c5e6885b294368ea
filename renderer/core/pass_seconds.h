#pragma once

#include "renderer/core/clock_seconds.h"

namespace lacuna {

/// CPU seconds of the process since the last end().
class PassSeconds {
 public:
  void end(double& sum) {
    const double now = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    sum += now - start_;
    start_ = now;
  }

 private:
  double start_ = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
};

}  // namespace lacuna
