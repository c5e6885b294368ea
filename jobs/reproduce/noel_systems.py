"""Parts of the thesis' methods that this project does otherwise by default: clustered shading (chapter 7), interleaved shading
(8.5), the labelling by flat zones (10.3.2); and one shadow ray for all connections of a path, which it tells of as related work
(4.3.2.2)."""

from harness import many_lights
from harness.entry import Entries
from harness.many_lights import visibility
from harness.measured import error_at, exact, gain_at, geometric_mean_of, mean_of, median_of
from harness.run import Table, cell_with
from harness.verdict import at_least, at_most, beside, near
from noel_connections import SCENES, bdpt, with_scenes
from noel_shadows import GRID, RADII, job
from noel_shape import ROWS, analyse

ENTRIES = Entries()
SEEDS = 3
TESTED = "2048 light paths: tests of cones by clusters and their points / by all points"


def size(run):
    return {} if run.full else {"resolution": [512, 256]}


@ENTRIES.measured(
    "noel-clustered", "Noel 2015, 7.3.1 to 7.3.3, and Table 2, p. 105",
    "geometry clusters \"allow to quickly test if a group of view samples are outside a virtual light cone\"; both passes take time in "
    "proportion to the lights", "many_lights with visibility: gates",
    (at_most(TESTED, 1), beside("2048 light paths: time of the eye pass by clusters / by points"),
     near("LA: tests of clusters, 2048 light paths / 512", 49 / 12.3), near("IL: tests of points, 2048 / 512", 44.2 / 10.9)))
def clustered(run):
    """Tests of cones and time of the eye pass with geometry clusters and without; the pictures are the same."""
    rows = []
    for which, radius in RADII.items():
        found = {}
        for paths in (512, 1024, 2048):
            by = {}
            for tests in ("points", "clusters"):
                value = job("Sponza", visibility("gates", tests=tests), paths, 3, analysis={**GRID, "node_radius": radius}, **size(run))
                by[tests] = [r["integrator"] for r in run.repeated(f"{tests}-{radius}-{paths}", value, 4 * SEEDS)]
            found[paths] = by
            t = by["clusters"][0]
            rows.append((which, round(t["virtual_lights"]), *(f"{t[key]:.4g}" for key in (
                "geometry_clusters", "gate_tests_of_clusters", "gate_tests_of_points", "gate_tests_without_clusters")),
                         *(str(median_of([t["eye_pass_cpu_seconds"] for t in by[tests]])) for tests in by)))
        many, few = (found[paths]["clusters"] for paths in (2048, 512))
        run.found(TESTED, **{which: geometric_mean_of(
            [(t["gate_tests_of_clusters"] + t["gate_tests_of_points"]) / t["gate_tests_without_clusters"] for t in many])})
        run.found("2048 light paths: time of the eye pass by clusters / by points", **{which: median_of(
            [a["eye_pass_cpu_seconds"] / b["eye_pass_cpu_seconds"] for a, b in zip(many, found[2048]["points"])])})
        for quantity, key in (("LA: tests of clusters, 2048 light paths / 512", "gate_tests_of_clusters"),
                              ("IL: tests of points, 2048 / 512", "gate_tests_of_points")):
            run.found(quantity, **{which: geometric_mean_of([a[key] / b[key] for a, b in zip(many, few)])})
    run.tables.append(Table(("", "lights", "geometry clusters", "tests of clusters", "of their points", "of points, without clusters",
                             "eye pass by points, CPU s", "by clusters"), rows))
    run.note("sponza, atrium. A test is of one light's cone through one gate; without clusters it is of every point and every cone")


SUM, AWAY = "time of the sum, interleaved 8 x 8 / of all lights", "relMSE of interleaved 8 x 8 against all lights"


@ENTRIES.measured(
    "noel-interleaved", "Noel 2015, 8.5.2, p. 114, and 8.6",
    "interleaved shading over 8 x 8 pixels processes 16 of 1024 lights for each; the thesis leaves it to future work",
    "many_lights with visibility: node_maps", (beside(SUM), beside(AWAY), beside(f"{AWAY}, not filtered")))
def interleaved(run):
    """The sum with node maps where each of 8 x 8 pixels takes a 64th of the lights, filtered over as many pixels."""
    gathers = {"all": {"type": "all"}, "unfiltered": {"type": "random", "interleave": 8, "cull": False},
               "filtered": {"type": "random", "interleave": 8, "cull": False, "filter_radius": 4}}
    for which, radius in RADII.items():
        def told(name, how, gather, paths=2000, radius=radius):
            value = job("Sponza", how, paths, 3, analysis={**GRID, "node_radius": radius}, **size(run))
            value["integrator"]["gather"] = gather
            return [r["integrator"]["eye_pass_cpu_seconds"] for r in run.repeated(f"{name}-{radius}", value, SEEDS)]

        dark = told("dark", "none", gathers["all"], 1)
        seconds = {name: told(name, "node_maps", gather) for name, gather in gathers.items()}
        run.found(SUM, **{which: median_of([(a - d) / (b - d) for a, b, d in zip(seconds["filtered"], seconds["all"], dark)])})
        for name, quantity in (("filtered", AWAY), ("unfiltered", f"{AWAY}, not filtered")):
            run.found(quantity, **{which: mean_of([many_lights.errors(
                run, f"{name}-{radius}-{s}", f"all-{radius}-{s}")["relmse"] for s in range(SEEDS)])})
            run.show(f"{name}, {which}", run.place(f"{name}-{radius}-0"))
        run.show(f"all, {which}", run.place(f"all-{radius}-0"))
    run.note("sponza, atrium, 2000 light paths of one bounce; the filter is not in the time of the sum")


LABELLED = {"Door": ROWS[0], "Sponza": ROWS[2]}


@ENTRIES.measured(
    "noel-fig-81", "Noel 2015, Fig. 81, p. 146, and 10.3.2",
    "regions of constant opening have false positives, all of whose voxels lie in balls of another region", "analysis",
    tuple(at_least(f"{scene}: regions of constant opening / of the opening forest", 1) for scene in LABELLED))
def fig_81(run):
    """Regions of both labellings. Every region of the forest has voxels that are their own centres, its roots, and all
    roots of a region lie in one flat zone: there are at least as many zones without a root as there are more zones."""
    rows = []
    run.uses([row[1] for row in LABELLED.values()])
    for scene, row in LABELLED.items():
        zones, forest = (analyse(*row[1:4], "--regions", labelling) for labelling in ("openings", "forest"))
        run.found(f"{scene}: regions of constant opening / of the opening forest",
                  published=exact(zones["regions"] / forest["regions"]))
        rows.append((scene, zones["regions"], zones["portals"], forest["regions"], forest["portals"],
                     f"{1 - forest['regions'] / zones['regions']:.3g}"))
    run.tables.append(Table(("scene", "flat zones", "portals", "regions of the forest", "portals",
                             "share of zones without a root, at least"), rows))


ALL, ONE = bdpt({"type": "paired"}), bdpt({"type": "paired", "rays": "one"})
WHERE = ("door", "sponza")


def rays_sweep(full):
    value = with_scenes({
        "label": "shadow rays of connections",
        "axes": {"/integrator": [ALL, ONE]},
        "job": {},
        "seeds": SEEDS,
        "baseline": {"/integrator": ALL},
        "compare_at": {"clock": "cpu_seconds", "metric": "relmse"},
    }, [SCENES[s] for s in WHERE], full)
    value["job"]["budget"] = {"cpu_seconds": 120 if full else 4}
    return value


@ENTRIES.measured(
    "noel-one-ray", "Noel 2015, section 4.3.2.2, p. 50",
    "one shadow ray for all connections of a path \"can be used to improve the efficiency\", but a choice without visibility adds \"too "
    "much variance in highly occluded scenes\"", "bdpt with connections: paired",
    tuple(claim for scene in WHERE for claim in (
        at_most(f"{scene}: shadow rays of a sample, one / all", 1), beside(f"{scene}: error of all / of one, at equal time"))),
    sweep=rays_sweep)
def one_ray(run):
    """Shadow rays a sample, with those of t = 1, and the error at equal time."""
    answers, rows = run.answers(rays_sweep(run.full)), []
    for scene in WHERE:
        cells = {name: cell_with(answers, scene=SCENES[scene]["/scene"], integrator=how)
                 for name, how in (("all", ALL), ("one", ONE))}
        rays = {name: [c["shadow_rays"] / c["samples"] for c in (run.report(cell, s)["counts"] for s in range(SEEDS))]
                for name, cell in cells.items()}
        run.found(f"{scene}: shadow rays of a sample, one / all", published=geometric_mean_of(
            [a / b for a, b in zip(rays["one"], rays["all"])]))
        run.found(f"{scene}: error of all / of one, at equal time", published=gain_at(cells["one"]["at"][-1]))
        rows += [(scene, name, f"{rays[name][0]:.3g}", str(error_at(cell["at"][-1]))) for name, cell in cells.items()]
    run.tables.append(Table(("scene", "shadow rays", "of a sample", "relMSE"), rows))
