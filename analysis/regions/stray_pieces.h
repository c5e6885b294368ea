#pragma once

#include "analysis/parallel/thread_pool.h"
#include "analysis/regions/forest_labels.h"

namespace lacuna {

/// Makes every region 6-connected. Noel 2015 (10.3.3) counts on Alg. 6 for trees that are, but
/// where a larger ball covers what lies between a ball's rim and its centre, the rim is cut off: in
/// about one of a hundred regions of random rooms. No choice of forest can always mend that, so a
/// piece without its region's root goes to the region that it shares most faces with (the lower
/// label among equals). Returns how many pieces did.
std::size_t join_stray_pieces(RegionLabels& labels, const ThreadPool& pool);

}  // namespace lacuna
