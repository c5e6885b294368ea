// Compiled for any x86-64 processor and run before all other code, which needs x86-64-v3.

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace {

__attribute__((constructor(101))) void check_processor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi2") != 0 &&
      __builtin_cpu_supports("fma") != 0) {
    return;
  }
  constexpr std::string_view message =
      "lacuna: this processor lacks AVX2, BMI2 or FMA; Lacuna needs x86-64-v3 (2013 or later)\n";
  if (write(STDERR_FILENO, message.data(), message.size()) < 0) _exit(2);
  _exit(1);
}

}  // namespace
