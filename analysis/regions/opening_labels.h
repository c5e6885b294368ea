#pragma once

#include "analysis/regions/forest_labels.h"

namespace lacuna {

/// The opening labelling (Noel 2015, 10.3.2): regions are the flat zones of the opening map, the
/// 6-connected sets of voxels of equal opening (def. 10.5, 10.6), numbered by their first voxels.
/// Reuses the memory of the forest for the labels, and temporarily needs runs along x.
RegionLabels opening_labels(OpeningForest forest, const ThreadPool& pool);

}  // namespace lacuna
