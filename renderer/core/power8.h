#pragma once

#include "analysis/geometry/simd.h"

namespace lacuna {

/// Base-2 logarithm of eight positive normal numbers, to a relative error of 2e-7: with the
/// mantissa m in [sqrt(1/2), sqrt(2)), log m = 2 atanh((m - 1) / (m + 1)), to five terms.
inline Float8 log2(Float8 x) {
  // Relative to the exponent of sqrt(1/2), so that the mantissa lies around 1.
  const Int8 exponent = (as_int(x) - Int8(0x3f3504f3)) >> 23;
  const Float8 m = as_float(as_int(x) - (exponent << 23));
  const Float8 z = (m - 1) / (m + 1);
  const Float8 z2 = z * z;
  constexpr float scale = 2.88539008F;  // 2 / ln 2
  Float8 sum = scale / 9;
  for (const float term : {scale / 7, scale / 5, scale / 3, scale}) sum = sum * z2 + term;
  return to_float(exponent) + sum * z;
}

/// 2^x of eight numbers up to 127, to a relative error of 3e-7; 0 below -126.
inline Float8 exp2(Float8 x) {
  const Float8 least = -126.0F;
  const Mask8 inside = x >= least;
  x = max(x, least);
  const Float8 whole = round(x);
  const Float8 part = x - whole;  // in [-1/2, 1/2]
  Float8 sum = 1.54035304e-4F;    // (ln 2)^k / k! for k = 6, 5, ...
  for (const float term :
       {1.33335581e-3F, 9.61812911e-3F, 5.55041087e-2F, 2.40226507e-1F, 6.93147181e-1F, 1.0F}) {
    sum = sum * part + term;
  }
  return keep_where(inside, as_float(as_int(sum) + (round_to_int(whole) << 23)));
}

/// c^s of eight numbers in [0, 1], s >= 0; 0 where c is 0 or denormal, also for s = 0.
inline Float8 power8(Float8 c, float s) {
  const Float8 least = 0x1p-126F;
  return keep_where(c >= least, exp2(Float8(s) * log2(max(c, least))));
}

}  // namespace lacuna
