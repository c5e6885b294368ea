"""What clusters and gates of the skeleton are made by, and what pictures with gates lose and gain: the radius of its nodes
(Noel 2015, 6.3), alpha of visibility clusters (7.2.2), and lighting without gates (7.4.1)."""

from harness import many_lights
from harness.entry import Entries
from harness.many_lights import visibility
from harness.measured import exact, geometric_mean_of, mean_of, median_of
from harness.run import Table
from harness.verdict import at_least, at_most, beside, near
from noel_shadows import CHESSBOARD, EDGES, GRID, PATHS, RADII, SEEDS, job
from noel_shape import ROWS, analyse

ENTRIES = Entries()
# The views of noel-table-3: both configurations are of sponza, the second one in the arcade. Each with its row of Table 1, at
# the coarser grid.
DOOR, _, SPONZA, *_ = ROWS
VIEWS = {"Sponza": SPONZA, "Arcade": SPONZA, "Door": DOOR}


def thesis_picture(run, view, key, how, seed, analysis=None):
    """The report of one of Table 3's pictures, called VIEW-KEY-SEED; small and of fewer lights in the quick form.
    `analysis`: settings of the shape analysis."""
    more = {"analysis": {**GRID, **(analysis or {})}, **({} if run.full else {"resolution": [256, 128]})}
    paths = PATHS if run.full else PATHS // 4
    return many_lights.render(run, f"{view}-{key}-{seed}", job(view, how, paths, EDGES, seed, **more))


def thesis_errors(run, view, variants, seeds=3):
    """Of each variant, by its name, what `lacuna compare` says of its pictures against exact visibility of the same
    lights; `variants`: the visibility and the settings of the analysis."""
    found = {key: [] for key in variants}
    for seed in range(seeds):
        thesis_picture(run, view, "exact", "exact", seed)
        for key, (how, analysis) in variants.items():
            thesis_picture(run, view, key, how, seed, analysis)
            found[key].append(many_lights.errors(run, f"{view}-{key}-{seed}", f"{view}-exact-{seed}"))
    return found


def display_mse(errors):
    return mean_of([e["display_mse"] for e in errors])


def mse_ratio(errors, others):
    """By seeds."""
    return geometric_mean_of([a["display_mse"] / b["display_mse"] for a, b in zip(errors, others)])


def light(errors):
    """The mean of pictures over that of exact visibility."""
    return mean_of([e["mean_a"] / e["mean_b"] for e in errors])


@ENTRIES.measured(
    "noel-radii", "Noel 2015, section 6.3, and Table 5, p. 167",
    "the radius of a node from distances of voxels (published) or of the node itself (ours): what it makes of the skeleton",
    "analysis; many_lights with visibility: gates",
    tuple(claim for scene, nodes in (("Door", 74), ("Sponza", 666)) for claim in (
        near(f"{scene}, filtered nodes", nodes, why=CHESSBOARD), beside(f"{scene}, clusters"), beside(f"{scene}, gates"),
        beside(f"{scene}, gates of radius 0"))) +
    tuple(beside(f"{view}, squared error with gates, voxel / corner") for view in VIEWS))
def radii(run):
    """What the two radii of a node make of the skeleton: how many nodes are left by the filter (Alg. 4), clusters, gates and
    how many of these are shut, at the thesis' grids (Table 5 does not name its own); and the squared error of pictures with
    gates, as in Table 3."""
    shapes, rows = {}, []
    run.uses([row[1] for row in ROWS])
    for row in ROWS[:4]:
        for radius in (*RADII.values(), "chessboard"):
            shape = shapes[row, radius] = analyse(*row[1:], "--node-radius", radius)
            rows.append((row[0], radius, *(shape[key] for key in (
                "nodes", "filtered_nodes", "simplified_nodes", "clusters", "gates", "gates_of_radius_0"))))
    run.tables.append(Table(("thesis' grid", "radius", "nodes", "filtered", "simplified", "clusters", "gates", "of radius 0"),
                            rows))
    for scene, row in (("Door", DOOR), ("Sponza", SPONZA)):
        for which, radius in RADII.items():
            for key in ("filtered_nodes", "clusters", "gates", "gates_of_radius_0"):
                run.found(f"{scene}, {key.replace('_', ' ')}", **{which: exact(shapes[row, radius][key])})
        run.found(f"{scene}, filtered nodes", published=exact(shapes[row, "chessboard"]["filtered_nodes"]))
    pictures = []
    for view in VIEWS:
        found = thesis_errors(run, view, {radius: ("gates", {"node_radius": radius}) for radius in RADII.values()}, SEEDS)
        run.found(f"{view}, squared error with gates, voxel / corner",
                  published=mse_ratio(found["voxel"], found["corner"]))
        pictures += [(view, radius, str(display_mse(errors)), str(light(errors))) for radius, errors in found.items()]
        for key in ("exact", *RADII.values()):
            run.show(f"{view}, {key}", run.place(f"{view}-{key}-0"))
    run.tables.append(Table(("view", "radius", "MSE of 0 to 255", "mean / exact"), pictures))
    run.note("filtered nodes as published: by the chessboard distance and the filter of the author's code")
    run.note(f"{SEEDS} seeds; views as in noel-table-3, pictures at the coarser grid, with alpha as in the thesis")


ALPHAS = (0, 0.1, 0.2, 0.4)
ALPHA_VIEWS = ("Sponza", "Door")
THESIS_ALPHA = 0.2


@ENTRIES.measured(
    "noel-alpha", "Noel 2015, section 7.2.2, p. 97",
    "alpha of visibility clusters: 20 % \"provide good results in term of convexity\"",
    "many_lights with visibility: gates",
    tuple(beside(f"{view}, squared error at alpha {alpha} / at {THESIS_ALPHA}")
          for view in ALPHA_VIEWS for alpha in ALPHAS if alpha != THESIS_ALPHA))
def alphas(run):
    """Clusters, gates, and the squared error of pictures with gates, as in Table 3, against alpha."""
    rows = []
    for view in ALPHA_VIEWS:
        run.uses(VIEWS[view][1])
        for which, radius in RADII.items():
            found = thesis_errors(run, view, {f"{radius}-{alpha}": ("gates", {"node_radius": radius, "cluster_alpha": alpha})
                                              for alpha in ALPHAS})
            for alpha in ALPHAS:
                shape = analyse(*VIEWS[view][1:], "--node-radius", radius, "--cluster-alpha", alpha)
                errors = found[f"{radius}-{alpha}"]
                rows.append((view, radius, alpha, shape["clusters"], shape["gates"], str(display_mse(errors)),
                             str(light(errors))))
                if alpha != THESIS_ALPHA:
                    run.found(f"{view}, squared error at alpha {alpha} / at {THESIS_ALPHA}",
                              **{which: mse_ratio(errors, found[f"{radius}-{THESIS_ALPHA}"])})
    run.tables.append(Table(("view", "radius", "alpha", "clusters", "gates", "MSE of 0 to 255", "mean / exact"), rows))
    run.note("published: radius voxel, ours: corner; the coarser grid")


GATES = {"with": visibility("gates"), "without": visibility("gates", through_gates=False)}


@ENTRIES.measured(
    "noel-without-gates", "Noel 2015, section 7.4.1, p. 105",
    "without gates lights illuminate their own cluster: less time, and \"some long range lighting\" is lost",
    "many_lights with visibility: gates",
    tuple(claim for view in VIEWS for claim in (
        at_most(f"{view}, time of the eye pass, without / with", 1), at_most(f"{view}, light, without / with", 1),
        at_least(f"{view}, squared error, without / with", 1))))
def without_gates(run):
    """Time, light and squared error of pictures with gates, as in Table 3, and without."""
    rows = []
    for view in VIEWS:
        for which, radius in RADII.items():
            analysis = {"node_radius": radius}
            variants = {f"{radius}-{gates}": (how, analysis) for gates, how in GATES.items()}
            found = thesis_errors(run, view, variants, SEEDS)
            seconds = {gates: [thesis_picture(run, view, f"{radius}-{gates}", how, seed, analysis)["integrator"][
                "eye_pass_cpu_seconds"] for seed in range(SEEDS)] for gates, how in GATES.items()}
            if which == "published":
                for gates in GATES:
                    run.show(f"{view}, {gates} gates", run.place(f"{view}-{radius}-{gates}-0"))
            with_, without = (found[f"{radius}-{gates}"] for gates in GATES)
            ratios = {"time of the eye pass": median_of([b / a for a, b in zip(*seconds.values())]),
                      "light": geometric_mean_of([b["mean_a"] / a["mean_a"] for a, b in zip(with_, without)]),
                      "squared error": mse_ratio(without, with_)}
            for quantity, ratio in ratios.items():
                run.found(f"{view}, {quantity}, without / with", **{which: ratio})
            rows += [(view, radius, gates, str(median_of(seconds[gates])), str(light(errors)), str(display_mse(errors)))
                     for gates, errors in zip(GATES, (with_, without))]
    run.tables.append(Table(("view", "radius", "gates", "CPU seconds of the eye pass", "mean / exact", "MSE of 0 to 255"), rows))
    run.note("published: radius voxel, ours: corner; the coarser grid")
