"""The node mapping grid, by distance along the empty space (Alg. 5) or also by what a voxel sees, for every method that uses
it. The thesis expects that all its contributions gain from a mapping by visibility (7.4.2.1) and did not build one."""

from harness import layers, many_lights
from harness.entry import Entries
from harness.measured import error_at, exact, gain_at, geometric_mean_of
from harness.run import Table, cell_with
from harness.verdict import at_least, beside
from noel_connections import SCENES, bdpt, with_scenes
from noel_guides import OURS, as_published
from noel_shadows import job

ENTRIES = Entries()
MAPPINGS = ("geodesic", "visible")
POINTER = "/analysis/mapping"

# Sampling methods, which stay unbiased by either: their error at equal time.
SAMPLED = {
    "guide skeleton, as published": {"type": "path", "max_depth": 6, "as": "published", "guide": as_published(8)},
    "guide skeleton, ours": {"type": "path", "max_depth": 6, "guide": OURS},
    "guide learned_skeleton": {"type": "path", "max_depth": 6, "guide": {"type": "learned_skeleton"}},
    "connections skeleton": bdpt({"type": "skeleton"}),
    "light_guide skeleton": {"type": "sppm", "max_depth": 6, "light_guide": {"type": "skeleton"}},
}
SAMPLED_SCENES = ("door", "corridor")
# Approximations: their squared error on values of 0 to 255 against exact visibility of the same lights.
APPROXIMATED = ("gates", "node_maps")
APPROXIMATED_VIEWS = ("Sponza", "Door")
PATHS, EDGES, SEEDS = 1000, 5, 3


def mapping_sweep(full):
    """Every sampling method on every scene with both mappings. CPU seconds are the clock."""
    value = with_scenes({
        "label": "node mapping",
        "job": {"analysis": {"resolution": 128}},
        "axes": {"/integrator": list(SAMPLED.values()), POINTER: list(MAPPINGS)},
        "seeds": SEEDS,
        "baseline": {POINTER: "geodesic"},
        "compare_at": {"clock": "cpu_seconds", "metric": "mae"},
    }, [SCENES[s] for s in SAMPLED_SCENES], full)
    value["job"]["budget"] = {"cpu_seconds": 120 if full else 2}
    return value


LITTLE = ("what changes is little: 96.6 % of door's picture sees its node by the geodesic mapping and 98 % by the visible one "
          "(noel-fig-46), and the errors differ by 2 %")


def gain_claim(method, where):
    return at_least(f"{method}, {where}: error with geodesic / with visible", 1, why=LITTLE if where.lower() == "door" else "")


def measure_sampled(run):
    """The errors at equal time of unbiased methods."""
    answers, rows = run.answers(mapping_sweep(run.full)), []
    for method, integrator in SAMPLED.items():
        for scene in SAMPLED_SCENES:
            at = {m: cell_with(answers, scene=SCENES[scene]["/scene"], integrator=integrator, mapping=m)["at"][-1]
                  for m in MAPPINGS}
            run.found(gain_claim(method, scene).quantity, ours=gain_at(at["visible"]))
            rows.append((method, scene, *(str(error_at(at[m])) for m in MAPPINGS)))
    run.tables.append(Table((f"MAE after {at['visible']['seconds']:.3g} CPU seconds", "scene", *MAPPINGS), rows))


def measure_approximated(run):
    """The squared errors of approximate visibility."""
    rows, size = [], [512, 256] if run.full else [256, 128]
    for view in APPROXIMATED_VIEWS:
        def value(how, mapping="geodesic", view=view):
            return {**job(view, how, PATHS, EDGES), "resolution": size, "analysis": {"mapping": mapping}}

        run.repeated(f"{view}-exact", value("exact"), SEEDS)
        for how in APPROXIMATED:
            errors = {}
            for mapping in MAPPINGS:
                name = f"{view}-{how}-{mapping}"
                run.repeated(name, value(how, mapping), SEEDS)
                errors[mapping] = [many_lights.errors(run, f"{name}-{seed}", f"{view}-exact-{seed}")["display_mse"]
                                   for seed in range(SEEDS)]
                run.show(f"{view}, {how}, {mapping}", run.place(f"{name}-0"))
            run.found(gain_claim(how, view).quantity, ours=geometric_mean_of(
                [a / b for a, b in zip(errors["geodesic"], errors["visible"])]))
            rows.append((how, view, *(str(geometric_mean_of(errors[m])) for m in MAPPINGS)))
    run.tables.append(Table(("MSE of 0 to 255", "view", *MAPPINGS), rows))


@ENTRIES.measured(
    "noel-mapping", "Noel 2015, 7.4.2.1, which expects it and measures nothing",
    "every method that uses the node mapping grid gains from one by visibility", "path, bdpt, sppm, many_lights with mapping: visible",
    tuple(gain_claim(method, scene) for method in SAMPLED for scene in SAMPLED_SCENES) +
    tuple(gain_claim(how, view) for how in APPROXIMATED for view in APPROXIMATED_VIEWS),
    sweep=mapping_sweep)
def mapping(run):
    """Both mappings for every method that uses one."""
    measure_sampled(run)
    measure_approximated(run)
    run.note(f"{SEEDS} seeds each; geodesic: Alg. 5 of the thesis, the default; visible: the nearest node that the voxel sees, "
             "if there is one nearby")


# The thesis' apartment is not to be had; flat.glb is of our own making. Voxels along the longest side.
SHOWN = {"Door (144, 234, 54)": ({"scene": "door/scene.glb", "camera": "corner"}, 234),
         "Apartment (364, 200, 238)": ({"scene": "flat.glb", "camera": "first room"}, 364)}


def seen_share(run, name):
    """Of the pixels whose surface belongs to a node, those that see it: green, and red where they do not."""
    red, green, _ = layers.channels(run.place(name), "")
    known = sum(r > 0 or g > 0 for r, g in zip(red, green))
    return sum(g > r for r, g in zip(red, green)) / known


@ENTRIES.measured(
    "noel-fig-46", "Noel 2015, Figs 45 and 46, p. 91",
    "every surface point has a node of the skeleton and of the filtered skeleton", "inspect",
    tuple(beside(f"{scene}: share of the picture that sees its node, {m}") for scene in SHOWN for m in MAPPINGS))
def fig_46(run):
    """Node mapping grids on a view of each scene."""
    for scene, (where, resolution) in SHOWN.items():
        for mapping in MAPPINGS:
            def picture(show, scene=scene, where=where, resolution=resolution, mapping=mapping):
                name = f"{scene.split()[0]}-{show}-{mapping}"
                run.render(name, {**where, "resolution": [512, 256], "budget": {"iterations": 1},
                                  "analysis": {"resolution": resolution, "mapping": mapping},
                                  "integrator": {"type": "inspect", "show": show}})
                return name

            name = picture("nearest_node_visible")
            run.found(f"{scene}: share of the picture that sees its node, {mapping}", ours=exact(seen_share(run, name)))
            for show in ("node_mapping", "filtered_mapping"):
                run.show(f"{scene.split()[0]}, {show}, {mapping}", run.place(picture(show)))
    run.note("Apartment: flat.glb, a stand-in of our own making")
