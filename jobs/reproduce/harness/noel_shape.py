"""Noel 2015, chapters 6 and 10.3: the shape of empty space."""

from harness.entry import Entry
from harness.verdict import at_least, at_most

ENTRIES = (
    Entry("noel-table-1", "Noel 2015, Table 1, p. 86, and section 6.2.5",
          "seconds to voxelise and thin (Intel Core i7-3770K of 2012, 8 threads), linear in the faces", "analysis",
          (at_most("Door (72, 118, 28)", 0.17, "s"), at_most("Door (144, 234, 54)", 1.28, "s"),
           at_most("Sponza (118, 50, 72)", 0.92, "s"), at_most("Sponza (234, 98, 144)", 6.81, "s"),
           at_most("Plants (118, 16, 68)", 1.17, "s"), at_most("Plants (234, 32, 134)", 4.57, "s"),
           at_most("Apartment (234, 128, 152)", 11, "s"), at_most("Apartment (364, 200, 238)", 45, "s"),
           at_most("Door: exponent of seconds in faces", 1), at_most("Sponza: exponent of seconds in faces", 1))),
    Entry("noel-skeletons", "the thesis author's published code, run on its own grids (shared/baselines)",
          "how far his skeletons and ours lie from each other, and from the scene", "analysis"),
    Entry("noel-fig-86", "Noel 2015, Fig. 86, p. 151",
          "rays through a portal leave the region: from the back room of door, from under the table",
          "path with guide: portals",
          (at_least("share of 128 rays from the back room that reach the main room", 1),
           at_least("share of rays from under the table that leave the region", 1))),
)
