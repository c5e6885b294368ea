#pragma once

#include "analysis/regions/forest_labels.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Makes every region 6-connected. Noel 2015 (10.3.3) expects Alg. 6 to give connected trees, but
/// where a larger ball covers the space between a ball's rim and its centre, the rim is cut off: 3
/// pieces beside the 196 regions of the thesis' door at 288 x 466 x 108, 3162 beside the 6047 of
/// 256^3 random blobs. Whether another choice among the balls of eq. 182 could avoid this is open:
/// here a piece without its region's root joins the region with which it shares the most faces (the
/// lower label among equals). Returns the number of such pieces.
std::size_t join_stray_pieces(RegionLabels& labels, const ThreadPool& pool);

}  // namespace lacuna
