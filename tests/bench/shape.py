"""From empty voxels to the skeleton and the node map: seconds, memory, and how both grow."""

import gzip
import json
import math
import os
import statistics
import subprocess

MB = 1e6

# Grid, seconds and memory of the thesis author's own code on it, bounds of ours.
AUTHORS = (("door_128", 0.097, 60, 0.01, None),
           ("door_256", 0.85, 176, 0.05, None),
           ("door_512", 7.9, 1240, 0.3, 200))


def of_grid(binary, grid, runs):
    done = subprocess.run([binary / "bench_shape", grid, str(runs)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def analyze(bench, binary, scene, resolution):
    """Seconds of each step, and the whole JSON."""
    done = subprocess.run([binary / "lacuna", "analyze", scene, "--resolution", str(resolution), "--no-cache", "--json"],
                          check=True, capture_output=True, text=True,
                          env={**os.environ, "LACUNA_DATA": str(bench.folder / "data")})
    told = json.loads(done.stdout)
    return {step["name"]: step["seconds"] for step in told["steps"]}, told


def figures(bench, name, seconds, bound, peak, peak_bound):
    bench.figure(f"{name}: seconds, median", f"{seconds:.4f}", f"at most {bound}", seconds <= bound)
    if peak_bound:
        bench.figure(f"{name}: memory, peak", f"{peak / MB:.0f} MB", f"at most {peak_bound} MB",
                     peak <= peak_bound * MB)


def grids(bench, binary, baselines):
    for name, author, author_mb, bound, memory in AUTHORS:
        file = bench.folder / f"{name}.vox"
        file.write_bytes(gzip.decompress((baselines / f"{name}.vox.gz").read_bytes()))
        told = of_grid(binary, str(file), 7)
        figures(bench, name, statistics.median(told["seconds"]), bound, told["peak_bytes"], memory)
        steps = ", ".join(f"{k} {statistics.median(told[k]):.4f}" for k in ("distance", "thinning", "graph", "map"))
        print(f"  {steps}; the author's code: {author} s, {author_mb} MB")
    told = of_grid(binary, "blobs:512", 1)
    figures(bench, "512^3 blobs", told["seconds"][0], 10, told["peak_bytes"], 1500)
    print(f"  {told['squares_pierced']} squares pierced, {told['layers']} layers")


def scenes(bench, binary):
    # The corridor's grid is the author's 466 x 170 x 384.
    for scene, resolution, bound, memory, steps in (
            ("corridor/scene.glb", 466, 0.7, 400, ("skeleton", "node_map")),
            ("sponza/scene.glb", 512, 4, 1500, ("voxels", "domain", "skeleton", "node_map"))):
        runs = [analyze(bench, binary, scene, resolution) for _ in range(3)]
        seconds = statistics.median(sum(s[k] for k in steps) for s, _ in runs)
        peak = max(step["peak_memory_bytes"] for step in runs[0][1]["steps"] if step["name"] in steps)
        figures(bench, f"{scene} at {resolution}", seconds, bound, peak, memory)
        print(f"  {'x'.join(map(str, runs[0][1]['grid']))}, " +
              ", ".join(f"{k} {v:.3f}" for k, v in runs[0][0].items()))


def growth(bench, binary):
    """The exponent of seconds against faces, fitted over resolutions 64 to 512."""
    for scene in ("door", "corridor", "sponza"):
        points = []
        for resolution in (64, 91, 128, 181, 256, 362, 512):
            runs = [analyze(bench, binary, f"{scene}/scene.glb", resolution) for _ in range(3)]
            seconds = min(s["skeleton"] + s["node_map"] for s, _ in runs)
            points.append((math.log(runs[0][1]["complex_faces"]), math.log(seconds)))
        x, y = zip(*points)
        exponent = statistics.linear_regression(x, y).slope
        bench.figure(f"{scene}: seconds grow with faces to the power of", f"{exponent:.3f}", "at most 1.05",
                     exponent <= 1.05)
        print("  " + ", ".join(f"{math.exp(f) / 1e6:.1f}M {math.exp(s):.3f} s" for f, s in points))


def run(bench, binary, baselines):
    grids(bench, binary, baselines)
    scenes(bench, binary)
    growth(bench, binary)
