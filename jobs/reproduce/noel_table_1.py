"""Noel 2015, Table 1: seconds to voxelise a scene and to thin its empty space (an Intel Core i7-3770K of 2012, 8
threads), beside ours on this machine. Scenes that the thesis has and this project has not are left out."""

import json
import pathlib
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Scene, its camera, voxels along the longest side; the thesis' grid and seconds.
ROWS = (
    ("door/scene.glb", "corner", 118, (72, 118, 28), 0.17),
    ("door/scene.glb", "corner", 234, (144, 234, 54), 1.28),
    ("sponza/scene.glb", "", 118, (118, 50, 72), 0.92),
    ("sponza/scene.glb", "", 234, (234, 98, 144), 6.81),
)
COUNTED = ("voxels", "domain", "skeleton")  # what the thesis' seconds hold
RUNS = 5


def analyse(scene, camera, resolution):
    command = [ROOT / "build/release/bin/lacuna", "analyze", scene, "--resolution", str(resolution), "--no-cache", "--json"]
    done = subprocess.run(command + (["--camera", camera] if camera else []), stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


def main():
    print(f"{'scene':<18} {'thesis grid':>16} {'s':>6}   {'our grid':>16} {'s (median of ' + str(RUNS) + ')':>18} "
          f"{'faces':>10} {'nodes':>7} {'filtered':>8}")
    for scene, camera, resolution, grid, seconds in ROWS:
        runs = [analyse(scene, camera, resolution) for _ in range(RUNS)]
        ours = statistics.median(sum(s["seconds"] for s in r["steps"] if s["name"] in COUNTED) for r in runs)
        r = runs[0]
        print(f"{scene:<18} {'x'.join(map(str, grid)):>16} {seconds:>6.2f}   {'x'.join(map(str, r['grid'])):>16} "
              f"{ours:>18.3f} {r['complex_faces']:>10} {r['nodes']:>7} {r['filtered_nodes']:>8}")


if __name__ == "__main__":
    main()
