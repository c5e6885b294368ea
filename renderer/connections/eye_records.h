#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "renderer/path/guide.h"
#include "renderer/path/light_vertices.h"
#include "renderer/path/record_tree.h"
#include "renderer/path/strategy.h"

namespace lacuna {

/// Vertices of a few eye paths, traced in each iteration, that store distributions over light
/// vertices (Georgiev et al. 2012, "Importance Caching for Complex Illumination").
class EyeRecords {
 public:
  struct Record {
    Vertex vertex;
    int depth;  ///< edges from the eye
  };

  /// Traces `density` eye paths per pixel, up to `deepest` edges or as far as light vertices reach.
  void place(const IterationContext& context, const LightVertices& lights, double density,
             int deepest, Counters& counters);

  std::size_t size() const { return records_.size(); }
  const Record& operator[](std::size_t i) const { return records_[i]; }

  /// The records nearest to an eye vertex.
  struct Neighbours {
    static constexpr std::size_t most = 64;
    /// For CellStatistics: one cell for all vertices, because records change in each iteration.
    std::uint32_t cell = 0;
    std::size_t n = 0;
    std::array<std::uint32_t, most> index{};  ///< of the n records, for operator[]
  };
  /// The nearest `neighbours` records, or all if there are fewer. Requires neighbours <=
  /// Neighbours::most.
  Neighbours nearest(const Vertex& v, int neighbours) const {
    Neighbours found;
    const auto wanted = std::span(found.index).first(static_cast<std::size_t>(neighbours));
    found.n = tree_.nearest(surface_point(v), wanted);
    return found;
  }

 private:
  std::vector<Record> records_;
  RecordTree tree_;
};

/// Throws MemoryLimitError if there is no memory for `bytes_each` per pair of record and light
/// vertex. `who`: the name of the connection strategy, for the message.
void require_distributions(std::string_view who, std::size_t records, std::size_t bytes_each,
                           const LightVertices& lights);

/// The contributions of all light vertices of one length to a record of unit throughput, as
/// luminance; 0 if not finite.
struct RecordContributions {
  std::vector<double> full;        ///< with visibility
  std::vector<double> unshadowed;  ///< without visibility
  std::vector<double> bounded;     ///< also without the record's BSDF and the distance
  std::uint64_t rays = 0;          ///< traced
};

/// The contributions to compute; the others are 0.
struct WantedContributions {
  bool full = true;
  bool unshadowed = false;
  bool bounded = false;
  bool weighted = false;  ///< times the MIS weight of the connection; not `bounded`
};

/// The contributions of all vertices LightVertices::at(s, .) to `record`.
RecordContributions contributions_to(const EyeRecords::Record& record,
                                     const IterationContext& context, const LightVertices& lights,
                                     int s, const WantedContributions& wanted);

}  // namespace lacuna
