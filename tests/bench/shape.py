"""From empty voxels to the skeleton and the node map: time, memory, and how both grow.

Bounds of time are ratios to the yardstick (yardstick.h), measured beside each run; seconds are information.
In four runs on a busy machine, whose seconds differed by up to a factor of 2.6, the ratios of the large grids and of
the scenes differed by up to 19 %. Those of the small grids, which stay in a cache, differed by up to a factor of 2:
their bounds are wide."""

import gzip
import json
import math
import os
import statistics
import subprocess

MB = 1e6

# Grid, seconds and memory of the thesis author's own code on it, bounds of ours: yardsticks, MB.
AUTHORS = (("door_128", 0.097, 60, 0.6, None),
           ("door_256", 0.85, 176, 3.5, None),
           ("door_512", 7.9, 1240, 23, 200))


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


def yardstick(binary):
    """Seconds of the yardstick now."""
    done = subprocess.run([binary / "bench_shape", "yardstick", "3"], check=True, capture_output=True, text=True)
    return statistics.median(json.loads(done.stdout))


def figures(bench, name, runs, bound, peak, peak_bound):
    """`runs`: pairs of seconds, of the analysis and of the yardstick beside it."""
    ratio = statistics.median(s / y for s, y in runs)
    bench.figure(f"{name}: time / the yardstick's, median", f"{ratio:.3f}", f"at most {bound}", ratio <= bound)
    print(f"  seconds {statistics.median(s for s, _ in runs):.4f}, yardstick {statistics.median(y for _, y in runs):.4f}")
    if peak_bound:
        bench.figure(f"{name}: memory, peak", f"{peak / MB:.0f} MB", f"at most {peak_bound} MB",
                     peak <= peak_bound * MB)


def pairs(told):
    return list(zip(told["seconds"], told["yardstick"]))


def grids(bench, binary, baselines):
    for name, author, author_mb, bound, memory in AUTHORS:
        file = bench.folder / f"{name}.vox"
        file.write_bytes(gzip.decompress((baselines / f"{name}.vox.gz").read_bytes()))
        told = of_grid(binary, str(file), 7)
        figures(bench, name, pairs(told), bound, told["peak_bytes"], memory)
        steps = ", ".join(f"{k} {statistics.median(told[k]):.4f}" for k in ("distance", "thinning", "graph", "map"))
        print(f"  {steps}; the author's code: {author} s, {author_mb} MB")
    told = of_grid(binary, "blobs:512", 1)
    figures(bench, "512^3 blobs", pairs(told), 850, told["peak_bytes"], 1500)
    print(f"  {told['squares_pierced']} squares pierced, {told['layers']} layers")


def scenes(bench, binary):
    # The corridor's grid is the author's 466 x 170 x 384.
    for scene, resolution, bound, memory, steps in (
            ("corridor/scene.glb", 466, 46, 400, ("skeleton", "node_map")),
            ("sponza/scene.glb", 512, 84, 1500, ("voxels", "domain", "skeleton", "node_map"))):
        runs, times = [], []
        for _ in range(3):
            beside = yardstick(binary)
            runs.append(analyze(bench, binary, scene, resolution))
            times.append((sum(runs[-1][0][k] for k in steps), beside))
        peak = max(step["peak_memory_bytes"] for step in runs[0][1]["steps"] if step["name"] in steps)
        figures(bench, f"{scene} at {resolution}", times, bound, peak, memory)
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
