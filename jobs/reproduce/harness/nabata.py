"""Nabata et al.: probabilistic visibility of many lights. 512 x 512 pixels on a Xeon E5-2680v2 at 2.8 GHz."""

from harness.entry import Entry
from harness.verdict import at_least, beside

NEEDS = "many_lights with visibility: probabilistic, roulette, exact"

# Scene, and of probabilistic visibility and of Veach's roulette the speed-up over exact, and the share of tests saved.
SCENES = (("San Miguel", 2.60, 1.21, 0.88, 0.64), ("Hairball", 6.08, 2.45, 0.90, 0.63),
          ("Sponza", 2.12, 1.47, 0.90, 0.74), ("Museum", 2.56, 1.45, 0.90, 0.83))


def of_scene(scene, speed_up, speed_up_veach, saved, saved_veach):
    return (at_least(f"{scene}: speed-up", speed_up), beside(f"{scene}: speed-up, Veach", speed_up_veach),
            at_least(f"{scene}: tests saved", saved), beside(f"{scene}: tests saved, Veach", saved_veach))


ENTRIES = (
    Entry("nabata-table-1-2", "Nabata et al., Tables 1 and 2, section 5",
          "speed-up over all visibilities, and the share of visibility tests saved", NEEDS,
          tuple(claim for scene in SCENES for claim in of_scene(*scene))),
    Entry("nabata-fig-3", "Nabata et al., Fig. 3, section 5",
          "error and time against the number of cache points: time is linear, error levels off at about 2000", NEEDS,
          (beside("cache points from which on the error levels off", 2000),)),
    Entry("nabata-fig-4", "Nabata et al., Fig. 4, section 5",
          "Hairball: where lights are tested; seldom on plain walls, other than with Veach", NEEDS),
    Entry("nabata-fig-5", "Nabata et al., Fig. 5, section 5", "Hairball: lights within equal time (99 s, 101 s)", NEEDS,
          (beside("lights, probabilistic", 13000), beside("lights, exact", 2000),
           at_least("lights, probabilistic / exact", 13000 / 2000))),
    Entry("nabata-fig-6", "Nabata et al., Fig. 6, section 5",
          "interpolated visibility alone has steps in brightness, probabilistic visibility has none",
          "many_lights with visibility: probabilistic, interpolated"),
    Entry("nabata-fig-7", "Nabata et al., Fig. 7, section 5", "Museum, glossy, 300k lights: time at like quality",
          NEEDS, (beside("probabilistic", 1468, "s"), beside("exact", 3822, "s"), at_least("speed-up", 3822 / 1468))),
)
