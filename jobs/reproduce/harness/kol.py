"""Kol et al. 2018, MegaViews: many views through two hierarchies. GPU times (GeForce GTX 1080 Ti) are information."""

from harness.entry import Entry
from harness.verdict import at_least, at_most, beside

NEEDS = "many_lights with visibility: view_maps"

ENTRIES = (
    Entry("kol-fig-9", "Kol et al. 2018, section 3.2.4 (Fig. 9)", "few pairs of leaves need several pixels", NEEDS,
          (at_most("share of rendered pairs beyond a pixel", 0.05),)),
    Entry("kol-fig-10", "Kol et al. 2018, Fig. 10, section 4.1",
          "time grows less than linearly with views; against ManyLoDs at a million views ten times faster, in a tenth "
          "of the memory", f"{NEEDS} (megaviews, many_lods, per_view)",
          (at_most("exponent of time in views, 2k to 1M", 1), at_least("speed-up over ManyLoDs, 1M views", 10),
           at_least("memory of ManyLoDs / of ours, 1M views", 10), beside("speed-up over ManyLoDs, 2048 views", 1),
           at_most("share of time that culling saves", 0.2))),
    Entry("kol-fig-11", "Kol et al. 2018, Fig. 11, section 4.1.1",
          "sponza, 64K views: random views against lights of one bounce", NEEDS,
          (at_most("time of random views / of one bounce", 4),)),
    Entry("kol-fig-12", "Kol et al. 2018, Fig. 12, section 4.2", "time against the maps' resolution, 1M views",
          f"{NEEDS} (megaviews, many_lods)", (beside("time at twice the resolution / at one", 4),)),
    Entry("kol-fig-13", "Kol et al. 2018, Fig. 13, section 5.1",
          "sibenik, 64K lights: error and time of maps against the depth of both hierarchies", NEEDS,
          (beside("11 levels", 31, "ms"), beside("8 levels", 7, "ms"), at_least("time at 11 levels / at 8", 31 / 7),
           beside("leaves beyond a pixel, 8 levels / 11", 15))),
    Entry("kol-fig-14", "Kol et al. 2018, Fig. 14, section 5.1",
          "hairball: 64K maps of 16 x 16 against 1024 x 1024; at equal time that leaves 18 lights", NEEDS,
          (beside("lights of 1024 x 1024 at equal time", 18),)),
    Entry("kol-fig-15", "Kol et al. 2018, Fig. 15, section 5.1",
          "sibenik, 8K lights: maps of 64 x 64 against 16 x 16, and against ManyLoDs",
          f"{NEEDS} (megaviews, many_lods)", (at_least("error of 16 x 16 / of 64 x 64", 1),)),
    Entry("kol-fig-16", "Kol et al. 2018, Fig. 16, section 5.1",
          "sponza, 64 of 1M lights a pixel: culling before lights are drawn lessens noise", NEEDS,
          (at_least("share of leaf views culled", 0.94), at_least("error without culling / with", 1))),
    Entry("kol-fig-17", "Kol et al. 2018, Fig. 17, section 5.2", "san miguel, glowing particles: time of their maps",
          f"{NEEDS} (megaviews, many_lods), omnidirectional",
          (beside("4K particles", 21, "ms"), beside("64K particles", 184, "ms"),
           beside("speed-up over ManyLoDs, 64K particles", 2))),
)
