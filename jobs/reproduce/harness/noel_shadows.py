"""Noel 2015, chapters 7 and 8: approximate shadows of many lights."""

from harness.entry import Entry
from harness.verdict import at_most, beside

ENTRIES = (
    Entry("noel-table-2", "Noel 2015, Table 2, p. 105",
          "milliseconds of a frame with gates against the number of lights (a GPU)",
          "many_lights with visibility: gates", (beside("512 lights", 33.6, "ms"), beside("1024 lights", 57, "ms"), beside("2048 lights", 103.6, "ms"))),
    Entry("noel-table-3", "Noel 2015, Table 3, p. 106",
          "squared error on values of 0 to 255 with gates, against direct light only and no shadows of indirect light",
          "many_lights with visibility: gates, none",
          (beside("1, direct light", 111.96), beside("1, no shadows", 69.1091), beside("1, gates", 33.1041),
           at_most("1, gates / no shadows", 33.1041 / 69.1091), at_most("1, gates / direct light", 33.1041 / 111.96),
           beside("2, direct light", 39.7544), beside("2, no shadows", 170.121), beside("2, gates", 39.6128),
           at_most("2, gates / no shadows", 39.6128 / 170.121), at_most("2, gates / direct light", 39.6128 / 39.7544))),
    # Of each configuration the row of the most lights. Door's total, 76.4, is not the sum of its parts, 5.6 + 39.
    Entry("noel-table-4", "Noel 2015, Table 4, p. 115",
          "time of the sum with shadows of node maps over that without (a GPU, about 1900 lights)",
          "many_lights with visibility: node_maps, none",
          (at_most("Sponza1", 43.8 / 77.3), at_most("Sponza2", 67.1 / 78), at_most("Sponza3", 45.4 / 77),
           at_most("Sponza4", 17.4 / 76.3), at_most("Door", 76.4 / 76.4), at_most("Apartment1", 55.1 / 77.5),
           at_most("Apartment2", 60.4 / 77.5))),
)
