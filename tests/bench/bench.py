"""Measures what the project promises, as ratios within one run, and prints each figure beside its bound."""

import argparse
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import emitters
import guides as guide_gains
import peers
import regret
import sampler
import scaling
import shape
import visibility

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
SHARED = ROOT.parent / "shared/scenes"


class Bench:
    def __init__(self):
        self.missed = 0
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacuna-bench-"))
        os.environ["LACUNA_SCENES"] += f":{self.folder}"  # checks make scenes of their own

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)

    def figure(self, name, value, bound, good):
        self.missed += not good
        print(f"{name:<64} {value:>12}   {'ok' if good else 'MISSED'}: {bound}", flush=True)

    def render(self, name, spec, *arguments):
        """Renders a job in a folder of its own; gives the folder and the report."""
        file = self.folder / f"{name}.json"
        file.write_text(json.dumps(spec))
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        subprocess.run([BIN / "lacuna", "render", file, "--out", out, "-q", *arguments], check=True,
                       env={**os.environ, "LACUNA_DATA": str(self.folder / "data")})
        return out, json.loads((out / "report.json").read_text())

    def compare(self, a, b, block, *arguments):
        done = subprocess.run([BIN / "lacuna", "compare", a, b, "--block", str(block), *arguments], check=True,
                              capture_output=True, text=True)
        return {k: float(v) for k, v in re.findall(r"^(\S+) +(-?[0-9.e+-]+)(?: of .*)?$", done.stdout, re.M)}


def rays(bench, _):
    """Integrators against a bare Embree loop that sends the same rays."""
    for method, size, least in (("path", 512, 0.65), ("bdpt", 512, 0.6), ("many_lights", 96, 0.7)):
        for scene in ("door", "sponza"):
            picture = [str(size), str(size // 2), "6"]
            done = subprocess.run([BIN / "bench_rays", SHARED / scene / "scene.glb", *picture, "9", method],
                                  check=True, capture_output=True, text=True)
            ratio = float(re.search(r"ratio ([0-9.]+)", done.stdout)[1])
            bench.figure(f"{scene}: rays a CPU second, {method} / bare Embree loop", f"{ratio:.3f}", f"at least {least}",
                         ratio >= least)
            print("  " + done.stdout.strip())


def medians(bench, jobs, seconds, rounds=3):
    """Of each named job the median of `seconds` of its report, the jobs one after another in each round."""
    told = {name: [] for name in jobs}
    for _ in range(rounds):
        for name, spec in jobs.items():
            told[name].append(seconds(bench.render("timed", spec)[1]))
    return {name: sorted(values)[rounds // 2] for name, values in told.items()}


def guides(bench, _):
    """An iteration of guided path tracing against one of BSDF sampling; learning takes its time, too."""
    guides = {"bsdf": {}, "skeleton": {"strength": 16}, "portals": {}, "face_irradiance": {}, "sd_tree": {},
              "learned_skeleton": {}}
    for scene, camera in (("door", "corner"), ("corridor", "far-from-light")):
        cpu = medians(bench, {name: {"scene": f"{scene}/scene.glb", "camera": camera, "resolution": [512, 256],
                                     "integrator": {"type": "path", "max_depth": 6, "guide": {"type": name, **more}},
                                     "budget": {"iterations": 16}} for name, more in guides.items()},
                      lambda report: report["seconds"]["render_cpu"])
        for name in guides:
            ratio = cpu[name] / cpu["bsdf"]
            if name == "skeleton":
                bench.figure(f"{scene}: an iteration guided by the skeleton / by the BSDF", f"{ratio:.2f}", "at most 1.5",
                             ratio <= 1.5)
            elif name != "bsdf":
                print(f"  {scene}: an iteration with {name} / with bsdf: {ratio:.2f}")


def views(bench, _):
    """Maps of the lights of sponza as published, with the paper's six million leaves of the scene, and with the defaults:
    through both hierarchies, through that of the scene for each single view, and by rays."""
    kinds = {"published": {"levels": 9.675, "node_texels": 1, "cover": 0, "bounds": "spheres", "split": "position"}, "defaults": {}}

    def job(kind, method, paths):
        single = {} if method == "megaviews" else {"share": "none"}
        return {"scene": "sponza/scene.glb", "camera": "atrium", "resolution": [32, 16], "budget": {"iterations": 1},
                "integrator": {"type": "many_lights", "max_depth": 3, "light_paths": paths, "compensation": False,
                               "visibility": {"type": "view_maps", "method": method, **kinds[kind], **single}}}

    def seconds(report):
        return report["integrator"]["view_map_cpu_seconds"]

    for kind in kinds:
        cpu = medians(bench, {(m, n): job(kind, m, n) for m in ("megaviews", "many_lods", "per_view") for n in (32768, 131072)},
                      seconds)
        for n in (32768, 131072):
            gain = cpu["many_lods", n] / cpu["megaviews", n]
            bench.figure(f"sponza, {kind}, {n} views: time of ManyLoDs / of MegaViews", f"{gain:.2f}", "above 1.5", gain > 1.5)
            print(f"  rays / MegaViews: {cpu['per_view', n] / cpu['megaviews', n]:.2f}")
        growth = math.log2(cpu["megaviews", 131072] / cpu["megaviews", 32768]) / 2
        bench.figure(f"sponza, {kind}: exponent of time in views, 32k to 128k", f"{growth:.2f}", "at most 0.9", growth <= 0.9)


def corridor(bench, options):
    """The thesis author's own render, 63,555 samples a pixel."""
    out, report = bench.render("corridor", {
        "scene": "corridor/scene.glb", "resolution": [512, 512],
        "integrator": {"type": "path", "max_depth": 6},
        "budget": {"cpu_seconds": options.seconds}, "layers": ["variance"]})
    c = bench.compare(out / "image.exr", SHARED / "corridor/reference.exr", 64)
    # The standard error of the picture's mean, from independent pixels.
    noise = report["errors"]["est_rmse"] / 512 / c["mean_b"]
    bench.figure("corridor: difference of means", f"{100 * c['mean_relative']:+.3f} %",
                 f"0.5 % (own noise {100 * noise:.3f} %)", abs(c["mean_relative"]) <= 0.005)
    # Of pure noise; a block's channels share their random numbers, so they count once. 4.5 deviations.
    blocks = c["blocks"]
    of_mean, of_deviation = 4.5 / math.sqrt(blocks), 4.5 / math.sqrt(2 * blocks)
    bench.figure("corridor: z of 64x64 blocks, mean", f"{c['z_mean']:+.3f}", f"within {of_mean:.2f}",
                 abs(c["z_mean"]) <= of_mean)
    bench.figure("corridor: z of 64x64 blocks, deviation", f"{c['z_deviation']:.3f}", f"1 within {of_deviation:.2f}",
                 abs(c["z_deviation"] - 1) <= of_deviation)


def cornell(bench, options):
    """Tungsten's render of the Cornell box, whose pixels are filtered with a tent."""
    out, _ = bench.render("cornell-box", {
        "scene": "cornell-box/scene.glb", "resolution": [1024, 1024], "pixel_filter": "tent",
        "integrator": {"type": "path", "max_depth": 64},
        "budget": {"cpu_seconds": options.seconds}, "layers": ["variance"]})
    reference = SHARED / "cornell-box/reference-tungsten.exr"
    # The front edge of the lamp (radiance 17) lies at row 96.035, on a border of the aligned blocks. There the
    # picture is what the pixel filter makes it, and Tungsten's tent is wider than a tent: its sampler takes
    # the density of each of 31 bins for the bin after it. Blocks moved by half their size hold the edge inside.
    aligned = bench.compare(out / "image.exr", reference, 32)
    print(f"  aligned blocks: largest difference {100 * aligned['block_relative']:.2f} %, where the lamp's edge is a border")
    c = bench.compare(out / "image.exr", reference, 32, "--crop", "16", "16", "992", "992")
    print(f"  z of the blocks: mean {c['z_mean']:+.3f}, deviation {c['z_deviation']:.3f}")
    bench.figure("cornell-box: largest difference of a 32x32 block's mean", f"{100 * c['block_relative']:.2f} %",
                 "1 %", c["block_relative"] <= 0.01)


def overhead(bench, _):
    """What is not rendering, of a job of 60 seconds: errors, checkpoints, files."""
    spec = {"scene": "door/scene.glb", "resolution": [1024, 512], "budget": {"seconds": 60}}
    # A reference that costs nothing: any picture of the right size.
    bench.render("size", {**spec, "budget": {"iterations": 1}})
    start = time.monotonic()
    _, report = bench.render("door", {**spec, "reference": "size/image.exr"})
    wall = time.monotonic() - start
    seconds = report["seconds"]
    extra = sum(seconds.get(k, 0) for k in ("evaluate", "checkpoint", "preview", "progress", "write"))
    bench.figure("door 1024x512, 60 s: errors, checkpoints and files", f"{100 * extra / wall:.2f} %", "under 3 %",
                 extra < 0.03 * wall)
    bench.figure("door: seconds until rendering starts", f"{seconds['load']:.2f} s", "within 1 s",
                 seconds["load"] <= 1)


def node(bench, script):
    """A bench that prints its own figures; it counts as one."""
    done = subprocess.run(["node", pathlib.Path(__file__).parent / script], check=False)
    bench.missed += done.returncode != 0


def service(bench, _):
    """The service with 10,000 jobs, 64 polling clients and two renderers; then with 500 slow clients."""
    node(bench, "service.mjs")
    node(bench, "slow_clients.mjs")


def page(bench, _):
    """The page in Chromium with 10,000 jobs, and with a comparison of 20."""
    node(bench, "page.mjs")


def sweeps(bench, _):
    """What a sweep costs beside its runs, and how soon its report is seen."""
    node(bench, "sweeps.mjs")


def analysis(bench, _):
    """The skeletons of the thesis author's grids, of scenes, and of what is hard."""
    shape.run(bench, BIN, ROOT.parent / "shared/baselines")


def regrets(bench, options):
    """What it costs that `auto` chooses: the table of regrets."""
    regret.measure_all(bench, BIN, ROOT / "build/regret", options)


def selection(bench, options):
    """Next event estimation by the light tree against selection by power."""
    emitters.run(bench, BIN, options)


def gains(bench, options):
    """Guides against BSDF sampling and each other at equal CPU time."""
    guide_gains.run(bench, options.guide_seconds, options.guide_seeds, options.guide_scenes)


def spreading(bench, _):
    """Samples that are spread evenly against independent ones."""
    sampler.run(bench)


def beside(bench, options):
    """Lacuna beside Blender's Cycles at equal CPU time."""
    peers.run(bench, options)


def cores(bench, options):
    """How each method would scale to many cores, from its traces."""
    scaling.run(bench, options)


def guesses(bench, options):
    """Guesses of probabilistic visibility: variance times rays and CPU time."""
    visibility.run(bench, options)


def scale(bench, _):
    """100,000 job folders with a stand-in for Slurm, and merging: docs/scaling.md."""
    node(bench, "scale.mjs")


CHECKS = {"service": service, "page": page, "sweeps": sweeps, "rays": rays, "guides": guides, "views": views,
          "cornell": cornell, "overhead": overhead, "corridor": corridor, "analysis": analysis}
LONG = {"regret": regrets, "guide_gains": gains, "emitters": selection, "sampler": spreading, "scale": scale,
        "peers": beside, "scaling": cores, "visibility": guesses}  # only by name


def main():
    parser = argparse.ArgumentParser(prog="./dev bench", description=__doc__)
    parser.add_argument("checks", nargs="*", metavar="CHECK",
                        help=f"of {', '.join(CHECKS)} (default: all of these); {', '.join(LONG)}")
    parser.add_argument("--seconds", type=float, default=120, help="CPU seconds a thread for each picture")
    parser.add_argument("--regret-seconds", type=float, nargs="+", default=[3, 10], metavar="SECONDS",
                        help="budgets of the pictures of regret, CPU seconds a thread (default: 3 10)")
    parser.add_argument("--regret-seeds", type=int, default=3)
    parser.add_argument("--regret-scenes", nargs="+", choices=regret.SCENES, metavar="SCENE",
                        help=f"of {', '.join(regret.SCENES)} (default: all)")
    parser.add_argument("--peers-seconds", type=float, default=6, help="CPU seconds of all threads for each picture of peers")
    parser.add_argument("--peers-scenes", nargs="+", choices=peers.SCENES, metavar="SCENE",
                        help=f"of {', '.join(peers.SCENES)} (default: all)")
    parser.add_argument("--scaling-sizes", nargs="+", choices=scaling.SIZES, default=list(scaling.SIZES))
    parser.add_argument("--scaling-methods", nargs="+", choices=scaling.METHODS, metavar="METHOD",
                        help=f"of {'; '.join(scaling.METHODS)} (default: all)")
    parser.add_argument("--scaling-scenes", nargs="+", choices=scaling.SCENES, default=list(scaling.SCENES))
    parser.add_argument("--scaling-iterations", type=int, default=3, help="of each run")
    parser.add_argument("--guide-seconds", type=float, default=6, help="CPU seconds for each picture of guide_gains")
    parser.add_argument("--guide-seeds", type=int, default=3, help="at least 2")
    parser.add_argument("--guide-scenes", nargs="+", choices=guide_gains.SCENES, metavar="SCENE",
                        help=f"of {', '.join(guide_gains.SCENES)} (default: all)")
    parser.add_argument("--visibility-seeds", type=int, default=3, help="at least 2")
    parser.add_argument("--visibility-width", type=int, default=256, help="pixels; half as many rows")
    parser.add_argument("--visibility-paths", type=int, default=3000, help="light paths")
    parser.add_argument("--visibility-iterations", type=int, default=8)
    parser.add_argument("--visibility-scenes", nargs="+", choices=visibility.SCENES, metavar="SCENE",
                        help=f"of {', '.join(visibility.SCENES)} (default: all)")
    options = parser.parse_args()
    if options.guide_seeds < 2:
        parser.error(f"--guide-seeds {options.guide_seeds}: at least 2, because errors are told by pairs of pictures")
    known = {**CHECKS, **LONG}
    if unknown := [c for c in options.checks if c not in known]:
        parser.error(f"no check {unknown[0]}; there are {', '.join(known)}")
    if not SHARED.is_dir():
        print(f"bench: the real scenes are not there ({SHARED}); nothing to measure", file=sys.stderr)
        return 1
    with Bench() as bench:
        for name in options.checks or CHECKS:
            known[name](bench, options)
    print(f"{bench.missed} figures missed")
    return 1 if bench.missed else 0


if __name__ == "__main__":
    sys.exit(main())
