"""Regions and the rays that leave them, in pictures (10.3.5, 10.4.2); and rays along the skeleton (Fig. 70)."""

import math

from harness import layers
from harness.entry import Entries
from harness.measured import exact, mean_of
from harness.verdict import at_least, at_most
from noel_guides import as_published
from noel_regions import BEFORE, BSDF, DOOR, FACES, GRID, SLIT, SLIT_AREA, UNDER_TABLE, guide_rays

ENTRIES = Entries()
SEEDS = 10
LEAVING = {"type": "portals", "portal": "next", "probability": 0.5, "mixing": 0}


def share_leaving(told):
    return sum(ray["entered"] is not None for ray in told["rays"]) / max(1, len(told["rays"]))


def leaving(run, scene, place, resolution):
    """The shares of rays that leave a point's region: of portals, and of the BSDF."""
    return [mean_of([share_leaving(guide_rays(run, guide, place, 128, seed, resolution, scene)) for seed in range(SEEDS)])
            for guide in (LEAVING, BSDF)]


def show_regions(run, scene, camera, resolution):
    """A picture of the regions' labels; its colours."""
    name = f"regions-{len(run.shown)}"
    run.render(name, {"scene": scene, "camera": camera, "resolution": [512, 256], "budget": {"iterations": 1},
                      "analysis": {"resolution": resolution}, "integrator": {"type": "inspect", "show": "region_labels"}})
    run.show(f"{scene}, {resolution} voxels", run.place(name))
    return list(zip(*layers.channels(run.place(name), "")))


def largest_share(labels):
    counts = {label: labels.count(label) for label in set(labels) if any(label)}
    return max(counts.values()) / sum(counts.values()), sum(n >= len(labels) // 100 for n in counts.values())


LENGTH = "mean length of a ray, skeleton guiding / BSDF"


@ENTRIES.measured(
    "noel-fig-70", "Noel 2015, Fig. 70, p. 131", "corridor: rays of the BSDF stay nearby, rays of the skeleton lead to the light",
    "path with guide: skeleton", (at_least(LENGTH, 1),), targets=("lacuna", "guide_rays"))
def fig_70(run):
    """How far rays come from the floor in front of corridor's camera."""
    place = [4.1, 4.3, -3.6]

    def length(guide, seed):
        told = guide_rays(run, guide, place, 128, seed, 128, "corridor/scene.glb")
        return mean_of([math.dist([place[0], 0, place[2]], ray["at"]) for ray in told["rays"] if ray["at"]]).value

    run.found(LENGTH, published=mean_of([length(as_published(16), seed) / length(BSDF, seed) for seed in range(SEEDS)]))
    run.note(f"{SEEDS} times 128 rays; strength 16")


LARGEST = "share of its largest region, back room / main room"
PARTS = "regions of a hundredth of the picture or more, main room"


@ENTRIES.measured(
    "noel-fig-85", "Noel 2015, Fig. 85, p. 151", "door: the back room is one large region, the main room several", "inspect",
    (at_least(LARGEST, 1), at_least(PARTS, 2)))
def fig_85(run):
    """The regions of both rooms of door, by the share of a picture of each."""
    back = {"position": [100, 90, -120], "target": [-100, 30, -330], "fov": 75}
    (whole, _), (part, parts) = (largest_share(show_regions(run, DOOR, camera, GRID)) for camera in (back, "corner"))
    run.found(LARGEST, ours=exact(whole / part))
    run.found(PARTS, ours=exact(parts))


PLACES = {"sibenik": ("nave.glb", "door", [0.4, 1.7, 6.0], 138),  # where from, voxels along the longest side
          "sponza": ("sponza/scene.glb", "directional-light-from-power", [655, 200, 503], 118)}


def leave_claims(name):
    return (at_least(f"{name}: rays that leave the region, through portals / of the BSDF", 1),)


def measure_leaving(run, name):
    scene, camera, place, resolution = PLACES[name]
    show_regions(run, scene, camera, resolution)
    guided, local = leaving(run, scene, place, resolution)
    run.found(leave_claims(name)[0].quantity, published=guided.ratio(local))
    run.note(f"shares of 128 rays: {guided} through portals, {local} of the BSDF, from below {place}")


@ENTRIES.measured(
    "noel-fig-87", "Noel 2015, Figs 87 and 88, p. 152", "sibenik: rays through a region's portals leave it, local ones seldom",
    "path with guide: portals; inspect", leave_claims("sibenik"), targets=("lacuna", "guide_rays"))
def fig_87(run):
    """Rays from the floor of a church."""
    measure_leaving(run, "sibenik")
    run.note("nave.glb, a stand-in of our own making")


@ENTRIES.measured(
    "noel-fig-89", "Noel 2015, Fig. 89, p. 153", "sponza: rays through a portal leave a corridor behind drapes, local ones seldom",
    "path with guide: portals; inspect", leave_claims("sponza"), targets=("lacuna", "guide_rays"))
def fig_89(run):
    """Rays from the floor of an arcade."""
    measure_leaving(run, "sponza")


COVERED = "area of the door's portal / of its opening"


@ENTRIES.measured(
    "noel-fig-93", "Noel 2015, Fig. 93, p. 157", "a portal misses a part of the opening that rays can pass",
    "path with guide: portals", (at_most(COVERED, 1),), targets=("lacuna", "guide_rays"))
def fig_93(run):
    """The area of the portal in the opening of door over that of the opening, as in Fig. 90, at the grid of Fig. 85."""
    told = guide_rays(run, FACES["portals"]["one"], UNDER_TABLE, 0)
    run.found(COVERED, published=exact(told["guide"]["through_area"] / SLIT_AREA))
    show_regions(run, DOOR, {"position": BEFORE, "target": SLIT, "fov": 80}, GRID)
    run.note("that the border of a region misses none is not measured: nothing lists its faces")
