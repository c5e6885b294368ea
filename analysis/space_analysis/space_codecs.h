#pragma once

#include "analysis/artefacts/codec.h"
#include "analysis/octree/octree.h"
#include "analysis/regions/borders.h"
#include "analysis/regions/forest_labels.h"
#include "analysis/regions/portals.h"
#include "analysis/skeleton/clusters.h"
#include "analysis/skeleton/filter.h"
#include "analysis/skeleton/gates.h"
#include "analysis/skeleton/simplify.h"
#include "analysis/space/domain.h"
#include "analysis/space/voxelize.h"

/// How the artefacts of shape analysis are kept on disk. Every index that is read back lies in
/// what it points into within the same artefact; what points into another artefact (a map into its
/// graph) is checked by whoever holds both.
namespace lacuna {

#define LACUNA_DECLARE_CODEC(T)                         \
  template <>                                           \
  struct Codec<T> {                                     \
    static void write(ArtefactWriter& out, const T& v); \
    static T read(ArtefactReader& in);                  \
  }

LACUNA_DECLARE_CODEC(Voxels);
LACUNA_DECLARE_CODEC(Domain);
LACUNA_DECLARE_CODEC(FilteredSkeleton);
LACUNA_DECLARE_CODEC(SimplifiedSkeleton);
LACUNA_DECLARE_CODEC(VisibilityClusters);
LACUNA_DECLARE_CODEC(VisibilityGates);
LACUNA_DECLARE_CODEC(RegionLabels);
LACUNA_DECLARE_CODEC(Portals);
LACUNA_DECLARE_CODEC(Octree);

#undef LACUNA_DECLARE_CODEC

}  // namespace lacuna
