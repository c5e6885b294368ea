"""What pictures with gates show (7.4): colours of other surfaces, glossy reflections, steps where clusters meet."""

from harness import layers, many_lights
from harness.entry import Entries
from harness.measured import geometric_mean_of
from harness.verdict import at_least, at_most
from noel_regions import Borders, one_surface
from noel_shadows import EDGES, GRID, PATHS, RADII, job

ENTRIES = Entries()
NEEDS = "many_lights with visibility: gates, exact"
SEEDS = 3


def size(run):
    return {"resolution": [1024, 512] if run.full else [256, 128], "analysis": {**GRID, "node_radius": RADII["published"]}}


def picture(run, view, how, edges, seed, paths=PATHS, **more):
    """The channels of a picture of the thesis' views."""
    name = f"{view}-{how}-{edges}-{paths}-{seed}"
    many_lights.render(run, name, job(view, how, paths, edges, seed, **{**size(run), **more}))
    return layers.channels(run.place(name), ""), name


def hue_distance(a, b):
    """The mean distance of chromaticities, over the pixels that are lit in both."""
    found = []
    for p, q in zip(zip(*a), zip(*b)):
        if (x := sum(p)) > 0 and (y := sum(q)) > 0:
            found.append(sum(abs(c / x - d / y) for c, d in zip(p, q)))
    return sum(found) / len(found)


HUE = "distance of colours to exact visibility, with gates / of the surfaces' own"


@ENTRIES.measured("noel-fig-54", "Noel 2015, Fig. 54, p. 103", "gates keep the colours that light takes from surfaces nearby", NEEDS,
                  (at_most(HUE, 1),))
def fig_54(run):
    """Chromaticities of pictures with gates, and of the surfaces without any light."""
    ratios = []
    for seed in range(SEEDS):
        exact, name = picture(run, "Sponza", "exact", EDGES, seed, layers=["albedo"])
        gates, shown = picture(run, "Sponza", "gates", EDGES, seed)
        ratios.append(hue_distance(gates, exact) / hue_distance(layers.channels(run.place(name), "albedo"), exact))
    run.show("gates", run.place(shown))
    run.found(HUE, published=geometric_mean_of(ratios))
    run.note("sponza, atrium: the thesis names no view")


FEWER = "relative difference of pictures of two seeds (SMAPE), 512 lights / 4192"


@ENTRIES.measured("noel-fig-57", "Noel 2015, Fig. 57, p. 103", "glossy reflections in a church need many lights: 4192", NEEDS,
                  (at_least(FEWER, 1),))
def fig_57(run):
    """The noise of glossy reflections against the number of lights, which give the direct light, too."""
    nave = {**size(run), "scene": "nave.glb", "camera": "door", "material": {"name": "paving", "roughness": 0.2}}

    def difference(paths, pair):
        value = job("Sponza", "gates", paths, 3, **nave)
        value["integrator"]["direct"] = "lights"
        run.repeated(f"{paths}", value, 2 * SEEDS)
        return many_lights.errors(run, f"{paths}-{2 * pair}", f"{paths}-{2 * pair + 1}")["smape"]

    run.found(FEWER, published=geometric_mean_of([difference(512, pair) / difference(4192, pair) for pair in range(SEEDS)]))
    for paths in (512, 4192):
        run.show(f"{paths} light paths", run.place(f"{paths}-0"))
    run.note("nave.glb, a stand-in of our own making, with its paving glossy; the thesis' church has glossy glass")


STEP = "step of light with gates / with exact visibility, across borders of clusters / within them"
DISKS = "light with gates / of exact, door"


@ENTRIES.measured(
    "noel-fig-58", "Noel 2015, Fig. 58, p. 107", "pictures with gates have steps where clusters meet, and disks let too little through",
    f"{NEEDS}; inspect", (at_least(STEP, 1), at_most(DISKS, 1)))
def fig_58(run):
    """Steps of the ratio to exact visibility on the borders of visibility clusters; and the light that comes through disks."""
    side = size(run)["resolution"]
    run.render("clusters", {**job("Sponza", "gates", 1, 3), **size(run), "integrator": {"type": "inspect", "show": "visibility_clusters"},
                            "layers": ["normal", "depth"]})
    place = run.place("clusters")
    borders = Borders(list(zip(*layers.channels(place, ""))), one_surface(place), *side, max(2, side[0] // 128))
    steps = []
    for seed in range(SEEDS):
        gates, exact = ([sum(p) for p in zip(*picture(run, "Sponza", how, EDGES, seed)[0])] for how in ("gates", "exact"))
        steps.append(borders.step([a / b if b > 0 else 0.0 for a, b in zip(gates, exact)], darkest=0)[0])
    run.found(STEP, published=geometric_mean_of(steps))
    light = [[sum(map(sum, picture(run, "Door", how, EDGES, seed)[0])) for how in ("gates", "exact")] for seed in range(SEEDS)]
    run.found(DISKS, published=geometric_mean_of([a / b for a, b in light]))
    for view in ("Sponza", "Door"):
        for how in ("gates", "exact"):
            run.show(f"{view}, {how}", run.place(f"{view}-{how}-{EDGES}-{PATHS}-0"))
    run.show("clusters", place)
    run.note("borders on one surface, in strips as in noel-fig-92; sponza, atrium")
