#pragma once

#include <gtest/gtest.h>

#include <type_traits>

#include "renderer/core/vec.h"

namespace lacuna {

/// Each coordinate within `tolerance`.
template <class V>
void expect_near(const V& found, const std::type_identity_t<V>& wanted, float tolerance = 1e-6F) {
  for (int k = 0; k < int(V::dimensions()); ++k)
    EXPECT_NEAR(found[k], wanted[k], tolerance) << "axis " << k;
}

}  // namespace lacuna
