#include "renderer/materials/specular.h"

#include <cmath>

namespace lacuna {

double mean_dielectric_reflectance(double ior) {
  if (std::abs(ior - 1) < 1e-6) return 0;  // where the terms below cancel
  if (ior < 1) return 1 - (1 - mean_dielectric_reflectance(1 / ior)) * ior * ior;
  const double n = ior, n2 = n * n, n4 = n2 * n2;
  const double above = n - 1, below = n + 1, n4m = n4 - 1;
  return 0.5 + above * (3 * n + 1) / (6 * below * below) +
         n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log(above / below) -
         2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * n4m) +
         8 * n4 * (n4 + 1) / ((n2 + 1) * n4m * n4m) * std::log(n);
}

}  // namespace lacuna
