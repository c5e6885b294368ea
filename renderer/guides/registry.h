#pragma once

#include <concepts>

#include "renderer/guides/border_faces.h"
#include "renderer/guides/face_directions.h"
#include "renderer/guides/learned_skeleton.h"
#include "renderer/guides/portal_faces.h"
#include "renderer/guides/sd_tree.h"
#include "renderer/guides/skeleton_directions.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The registry's entry for the BSDF only.
struct NoDistribution {};

/// All guides: the BSDF only, or a distribution of directions that Guide mixes with it. A new guide
/// is a row here and an alternative of GuideSettings.
using GuideRegistry = Registry<
    Entry<BsdfGuideSettings, NoDistribution>, Entry<SkeletonGuideSettings, SkeletonDirections>,
    Entry<PortalsGuideSettings, FaceDirections<PortalFaces>>,
    Entry<FaceIrradianceGuideSettings, FaceDirections<BorderFaceLight>>,
    Entry<SdTreeGuideSettings, SdTree>, Entry<LearnedSkeletonGuideSettings, LearnedSkeleton>>;

static_assert(std::is_same_v<GuideRegistry::Settings, GuideSettings>,
              "the registry and the settings list the same guides in the same order");

}  // namespace lacuna
