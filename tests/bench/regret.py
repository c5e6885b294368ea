"""What choosing costs: `auto` beside the methods that it chooses from, each for the same CPU time, on many scenes.

The regret is the error of `auto` over that of the best of the others, each the geometric mean of the seeds': where rare
bright paths decide, a mean of a few seeds tells which seed met one. A fixed method runs once for the longest of the
budgets; its curve has its errors at the others. References are made by `path` with `reuse` 64 and a guide (by `bdpt` in
`many_lights`, where that is better) in 60 s with another seed. Their own error is a fifth of that of a picture which the
same method makes in 15 s, measured against them, and is taken off. Runs that are done are kept in build/regret, so that a
stopped table goes on; remove that folder to measure anew."""

import csv
import json
import math
import os
import statistics
import subprocess

LENGTHS = {"max_depth": 6}
GUIDED = {"type": "path", "reuse": 64, "guide": {"type": "learned_skeleton"}}
METHODS = {
    "path, reuse 16": {"type": "path", "reuse": 16},
    "path, learned_skeleton, reuse 64": GUIDED,
    "metropolis": {"type": "metropolis"},
    "bdpt, skeleton": {"type": "bdpt", "connections": {"type": "skeleton"}},
    "many_lights": {"type": "many_lights", "visibility": {"type": "probabilistic"}},
}
SCENES = {
    "ajar": {"scene": "ajar.glb", "camera": "room"},
    "bends": {"scene": "bends.glb", "camera": "entrance"},
    "cornell": {"scene": "cornell.glb", "camera": "front"},
    "atrium": {"scene": "atrium.glb", "camera": "arcade"},
    "many_lights": {"scene": "many_lights.glb", "camera": "corner"},
    "area": {"scene": "area.glb"},
    "open, sky": {"scene": "open.glb", "environment": {"file": "sky.hdr"}},
    "cornell-box": {"scene": "cornell-box/scene.glb"},
    "door": {"scene": "door/scene.glb", "camera": "corner"},
    "corridor": {"scene": "corridor/scene.glb", "camera": "far-from-light"},
    "sponza": {"scene": "sponza/scene.glb", "camera": "directional-light-from-power"},
}
METRICS = ("relmse", "mse")
BOUNDS = {3: (1.4, 3), 10: (1.2, 2), 60: (1.1, 1.5)}  # of the geometric mean and the worst, by seconds


class Runs:
    """Jobs in folders of their own below `folder`; those that are done are not rendered again."""

    def __init__(self, lacuna, folder):
        self.lacuna, self.folder = lacuna, folder
        (folder / "pictures").mkdir(parents=True, exist_ok=True)

    def curve(self, name, spec):
        """The folder of the job, and the rows of its curve."""
        job, out = self.folder / f"{name}.json", self.folder / f"{name}.job"
        text = json.dumps(spec, indent=1)
        if not (job.exists() and job.read_text() == text and (out / "report.json").exists()):
            if job.exists() and job.read_text() != text:
                raise SystemExit(f"bench: {job} is of another measurement; remove {self.folder}")
            job.write_text(text)
            roots = f"{os.environ.get('LACUNA_SCENES', '')}:{self.folder / 'pictures'}"
            subprocess.run([self.lacuna, "render", job, "--out", out, "-q"], check=True,
                           env={**os.environ, "LACUNA_SCENES": roots, "LACUNA_DATA": str(self.folder / "data")})
        with open(out / "curve.csv", newline="") as rows:
            return out, list(csv.DictReader(rows))

    def reference(self, slug, job):
        """The name of a picture below the scenes roots, and its own error by each metric."""
        best = {**({"type": "bdpt"} if slug == "many_lights" else GUIDED), **LENGTHS}
        out, _ = self.curve(f"reference-{slug}", {**job, "integrator": best, "budget": {"cpu_seconds": 60}, "seed": 1000})
        picture = self.folder / "pictures" / f"{slug}.exr"
        if not picture.exists():
            os.link(out / "image.exr", picture)
        _, rows = self.curve(f"reference-noise-{slug}", {**job, "integrator": best, "budget": {"cpu_seconds": 15},
                                                         "seed": 2000, "reference": picture.name})
        return picture.name, {m: float(rows[-1][m]) / 5 for m in METRICS}


def error_at(rows, metric, seconds, noise):
    """The error of a curve after `seconds`, without the reference's; none where that is most of it."""
    known = [r for r in rows if r[metric]]
    before = [r for r in known if float(r["cpu_seconds"]) <= 1.02 * seconds] or known[:1]
    error = float(before[-1][metric]) - noise
    # A squared error falls as one over the time; rows are sqrt(2) apart.
    error *= min(1.0, float(before[-1]["cpu_seconds"]) / seconds)
    return error if error > 0.3 * noise else None


def geometric(values):
    known = [math.log(v) for v in values if v is not None]
    return math.exp(statistics.mean(known)) if known else None


def measure(runs, name, budgets, seeds):
    """{(seconds, metric): {method: error}} of a scene, and {seconds: what auto chose}."""
    job = {**SCENES[name], "resolution": [256, 144]}
    slug = name.replace(", ", "-")
    picture, noise = runs.reference(slug, job)
    errors, chosen = {}, {}

    def add(method, rows, seconds):
        for m in METRICS:
            errors.setdefault((seconds, m), {}).setdefault(method, []).append(error_at(rows, m, seconds, noise[m]))

    for seed in range(1, seeds + 1):
        base = {**job, "seed": seed, "reference": picture}
        for method, integrator in METHODS.items():
            _, rows = runs.curve(f"{slug}-{method.replace(', ', '-')}-{seed}",
                                 {**base, "integrator": {**integrator, **LENGTHS}, "budget": {"cpu_seconds": max(budgets)}})
            for seconds in budgets:
                add(method, rows, seconds)
        for seconds in budgets:
            out, rows = runs.curve(f"{slug}-auto-{seconds:g}-{seed}", {**base, "integrator": {"type": "auto", **LENGTHS},
                                                                       "budget": {"cpu_seconds": seconds}})
            choice = json.loads((out / "choice.json").read_text())
            chosen.setdefault(seconds, set()).add(choice["candidates"][choice["chosen"]]["name"])
            add("auto", rows, seconds)
    return {key: {m: geometric(e) for m, e in of.items()} for key, of in errors.items()}, chosen


def measure_all(bench, binaries, folder, options):
    runs = Runs(binaries / "lacuna", folder)
    budgets, seeds = sorted(options.regret_seconds), options.regret_seeds
    found = {name: measure(runs, name, budgets, seeds) for name in options.regret_scenes or SCENES}
    for seconds in budgets:
        for metric in METRICS:
            regrets = table(found, seconds, metric, seeds)
            if metric == "relmse" and regrets:
                judge(bench, regrets, seconds)


def best_of(errors):
    """The least error of the fixed methods; None where none is known."""
    return min((e for m, e in errors.items() if m != "auto" and e), default=None)


def lines(found, seconds, metric, title, names):
    """The errors of each scene over the best fixed method's, as a table in Markdown. `names`: of the methods in it."""
    yield f"| {title} | {' | '.join(names[m] for m in (*METHODS, 'auto'))} | `auto` chose |"
    yield "| --- |" + " --- |" * (len(METHODS) + 2)
    for scene, (errors, chosen) in found.items():
        of = errors[seconds, metric]
        if best := best_of(of):
            cells = ["?" if of[m] is None else "**1**" if of[m] == best else f"{of[m] / best:.2g}" for m in (*METHODS, "auto")]
            yield f"| {scene} | {' | '.join(cells)} | {'; '.join(sorted(chosen[seconds]))} |"


def table(found, seconds, metric, seeds):
    """Prints the errors over the best fixed method's. Returns {scene: regret}."""
    print(f"\n{metric} over the best fixed method's, {seconds:g} CPU seconds a thread, {seeds} seeds\n")
    print(*lines(found, seconds, metric, "scene", {m: f"`{m}`" for m in (*METHODS, "auto")}), sep="\n")
    known = {scene: errors[seconds, metric] for scene, (errors, _) in found.items()}
    return {scene: of["auto"] / best for scene, of in known.items() if (best := best_of(of)) and of["auto"]}


def judge(bench, regrets, seconds):
    mean, most = BOUNDS[min(BOUNDS, key=lambda s: abs(math.log(s / seconds)))]
    value, worst = geometric(regrets.values()), max(regrets, key=regrets.get)
    print()
    bench.figure(f"regret, geometric mean, {seconds:g} s", f"{value:.2f}", f"at most {mean}", value <= mean)
    bench.figure(f"regret, worst, {seconds:g} s", f"{regrets[worst]:.2f}", f"at most {most} ({worst})", regrets[worst] <= most)
