#!/usr/bin/env python3
"""Makes the scenes of this folder, sky.hdr and README.md: the same bytes each time and everywhere.

make_scenes.py          writes them
make_scenes.py --check  compares them with what lies here and reads every scene anew (validate.py);
                        a line for each fault and exit code 1
"""

import pathlib
import sys

sys.dont_write_bytecode = True  # no cache folder beside the scenes

import rooms
import stand_ins
import trials
from hairball import hairball, hairball_2800k
from images import sky
from validate import faults

HERE = pathlib.Path(__file__).resolve().parent
ROOMS = [rooms.cornell, rooms.cornell_ball, rooms.bends, rooms.ajar, rooms.atrium]
TRIALS = [trials.furnace, trials.furnace_sphere, trials.mirror, trials.glass_room, trials.slab]
TRIALS += [trials.many_lights, trials.sides, trials.open_air]
TRIALS += [trials.point, trials.spot, trials.directional, trials.area]
TRIALS += [hairball, hairball_2800k]
TRIALS += [stand_ins.nave, stand_ins.flat, stand_ins.plants, stand_ins.plates]

README_HEAD = """# Scenes

Small scenes of Lacuna's own, CC0. `make_scenes.py` makes them and this page;
`make_scenes.py --check` tells whether they still agree. Metres, y up; radiance, W/sr and W/m^2 as
in the rest of Lacuna. Windings and normals point to the side that is meant to be seen; "closed"
means that no path leaves the scene.

| file | what it is for | light | space | cameras | triangles |
| --- | --- | --- | --- | --- | --- |
"""
README_TAIL = """
`sky.hdr` (64 x 32) is an environment for `open.glb`: a pale gradient over a dim ground, and a sun
of 2 x 2 pixels.

## Exact answers

"""


def all_files():
    """The name and the bytes of every file that this script makes."""
    scenes = [make() for make in ROOMS + TRIALS]
    files = {f"{s.name}.glb": s.bytes() for s in scenes}
    files["sky.hdr"] = sky()
    files["README.md"] = readme(scenes).encode()
    return files


def readme(scenes):
    rows = ""
    for s in scenes:
        cameras = ", ".join(f"`{c}`" for c in s.cameras())
        cells = [f"`{s.name}.glb`", s.purpose, s.light, s.closed, cameras, str(s.triangles)]
        rows += f"| {' | '.join(cells)} |\n"
    answers = "".join(f"- `{s.name}.glb`: {s.answer}.\n" for s in scenes if s.answer)
    return README_HEAD + rows + README_TAIL + answers


def check():
    found = []
    made = all_files()
    for name, data in made.items():
        path = HERE / name
        if not path.is_file():
            found.append(f"{name}: missing; run make_scenes.py")
        elif path.read_bytes() != data:
            found.append(f"{name}: differs from what make_scenes.py makes")
    for path in sorted(HERE.glob("*.glb")):
        if path.name not in made:
            found.append(f"{path.name}: not made by make_scenes.py")
        found += [f"{path.name}: {fault}" for fault in faults(path.read_bytes())]
    return found


def main():
    if sys.argv[1:] == ["--check"]:
        found = check()
        print("\n".join(found) or f"{len(ROOMS + TRIALS)} scenes agree with make_scenes.py")
        return 1 if found else 0
    if sys.argv[1:]:
        print(__doc__, file=sys.stderr)
        return 2
    for name, data in all_files().items():
        (HERE / name).write_bytes(data)
        print(f"{name}: {len(data)} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
