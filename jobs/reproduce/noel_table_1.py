"""Noel 2015, Table 1: seconds to voxelise a scene and to thin its empty space, and whether they are linear in the faces
of its cubical complex (section 6.2.5). Scenes that the thesis has and this project has not stay unmeasured."""

import math

from harness import child
from harness.measured import median_of
from harness.run import Table

# The thesis' scene and grid; ours, its camera, voxels along the longest side.
ROWS = (
    ("Door (72, 118, 28)", "door/scene.glb", "corner", 118),
    ("Door (144, 234, 54)", "door/scene.glb", "corner", 234),
    ("Sponza (118, 50, 72)", "sponza/scene.glb", "", 118),
    ("Sponza (234, 98, 144)", "sponza/scene.glb", "", 234),
)
GROWTH = (("Door", *ROWS[:2]), ("Sponza", *ROWS[2:]))
COUNTED = ("voxels", "domain", "skeleton")  # what the thesis' seconds hold


def analyse(scene, camera, resolution):
    return child.lacuna_json("analyze", scene, "--resolution", resolution, "--no-cache",
                             *(("--camera", camera) if camera else ()))


def counted_seconds(told):
    return sum(step["seconds"] for step in told["steps"] if step["name"] in COUNTED)


def growth(small, large):
    """The exponents with which seconds grow in faces, from the runs at two resolutions in pairs."""
    faces = math.log(large[0]["complex_faces"] / small[0]["complex_faces"])
    return [math.log(counted_seconds(b) / counted_seconds(a)) / faces for a, b in zip(small, large)]


def measure(run):
    told = {row: [] for row in ROWS}
    for _ in range(20 if run.full else 6):
        for row in ROWS:  # in turn: what the machine does meanwhile meets all alike
            told[row].append(analyse(*row[1:]))
    for row in ROWS:
        run.found(row[0], median_of([counted_seconds(t) for t in told[row]]))
    for scene, small, large in GROWTH:
        run.found(f"{scene}: exponent of seconds in faces", median_of(growth(told[small], told[large])))
    run.tables.append(Table(("thesis", "our grid", "faces", "nodes", "filtered"), [
        (row[0], "x".join(map(str, t["grid"])), t["complex_faces"], t["nodes"], t["filtered_nodes"])
        for row, (t, *_) in told.items()]))
    run.note(f"ours: medians of {len(told[ROWS[0]])} processes, nothing cached; wall clock: a busy machine only "
             "makes it longer")
