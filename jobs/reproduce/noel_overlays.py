"""Pictures of what the analysis finds, in the scene: its skeleton (chapter 6)."""

import os

from harness import child
from harness.entry import Entries
from harness.measured import exact
from harness.verdict import at_least, at_most

ENTRIES = Entries()
PLANTS = ("plants.glb", "chair", 234)
FLAT = ("flat.glb", "first room", 364)
SPONZA = {119: "(119, 51, 73)", 234: "(234, 98, 144)"}


def overlays(run, scene, camera, resolution, *shown):
    """What `analyze` says of a scene's shape; shows each of its overlays that `shown` names, as skeleton, seen by a camera."""
    folder = run.folder / "overlays"
    name = f"{scene.partition('.')[0].replace('/', '-')}-{resolution}"
    run.uses(scene)
    told = child.lacuna_json("analyze", scene, "--resolution", resolution, "--no-cache", "--out", folder / name)
    roots = os.environ.get("LACUNA_SCENES", "")
    os.environ["LACUNA_SCENES"] = f"{roots}:{folder}"
    known = dict(run.inputs)  # an overlay is made anew each time: no input
    try:
        for what in shown:
            run.render(f"{name}-{what}", {
                "scene": f"{name}/{what}.glb", "camera": camera, "resolution": [512, 256], "budget": {"iterations": 32},
                "integrator": {"type": "inspect", "show": "albedo"}})
            run.show(f"{scene}, {resolution} voxels, {what}", run.place(f"{name}-{what}"))
    finally:
        os.environ["LACUNA_SCENES"], run.inputs = roots, known
    return told


LOOPS = "loops of the skeleton, grid (234, 98, 144) / (119, 51, 73)"


@ENTRIES.measured(
    "noel-fig-38", "Noel 2015, Fig. 38, p. 85",
    "sponza's skeleton; only a finer grid has the small openings at its top", "analysis; inspect", (at_least(LOOPS, 1),))
def fig_38(run):
    """The skeleton of sponza at two resolutions. A passage that the coarse grid closes is a loop less."""
    told = [overlays(run, "sponza/scene.glb", "atrium", resolution, "skeleton") for resolution in SPONZA]
    run.found(LOOPS, ours=exact(told[1]["loops"] / told[0]["loops"]))
    for t in told:
        run.note(f"grid {t['grid']}: {t['nodes']} nodes, {t['loops']} loops, {t['components']} parts")


def filtered(number, page, scene, grid):
    return (f"noel-fig-{number}", f"Noel 2015, Fig. {number}, p. {page}",
            f"{scene}, grid {grid}: the filter leaves fewer nodes, where space is wide", "analysis; inspect",
            (at_most("filtered nodes / nodes", 1),))


def measure_filter(run, where):
    told = overlays(run, *where, "skeleton", "filtered")
    run.found("filtered nodes / nodes", ours=exact(told["filtered_nodes"] / told["nodes"]))
    run.note(f"{where[0]}, a stand-in of our own making: {told['nodes']} nodes, of which {told['filtered_nodes']} are left, "
             f"grid {told['grid']}")


@ENTRIES.measured(*filtered(42, 88, "plants", "(234, 32, 134)"))
def fig_42(run):
    """The skeleton and the filtered one among plants."""
    measure_filter(run, PLANTS)


@ENTRIES.measured(*filtered(43, 88, "apartment", "(364, 200, 238)"))
def fig_43(run):
    """The skeleton and the filtered one of rooms in a row."""
    measure_filter(run, FLAT)
