"""What choosing costs: `auto` beside the methods that it chooses from, each for the same CPU time, on many scenes.

The regret is the MSE of `auto` over that of the best of the others, each the geometric mean of the seeds': where rare
bright paths decide, a mean of a few seeds tells which seed met one. References are made by `auto` with another seed and
eight times the time; their own noise, which they estimate, is taken off. Runs that are done are kept in build/regret,
so that a stopped table goes on; remove that folder to measure anew."""

import json
import math
import os
import statistics
import subprocess

LENGTHS = {"max_depth": 6}
METHODS = {
    "path": {"type": "path"},
    "path, reuse 16": {"type": "path", "reuse": 16},
    "metropolis": {"type": "metropolis"},
    "bdpt": {"type": "bdpt"},
    "bdpt, skeleton": {"type": "bdpt", "connections": {"type": "skeleton"}},
    "many_lights": {"type": "many_lights", "visibility": {"type": "probabilistic"}},
    "auto": {"type": "auto"},
}
SINGLES = ("path", "path, reuse 16", "bdpt, skeleton", "metropolis")  # what one would always use
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
SECONDS_OF_A_REFERENCE = 8  # times a picture's


class Runs:
    """Jobs in folders of their own below `folder`; those that are done are not rendered again."""

    def __init__(self, lacuna, folder):
        self.lacuna, self.folder = lacuna, folder
        (folder / "pictures").mkdir(parents=True, exist_ok=True)

    def report(self, name, spec):
        job, out = self.folder / f"{name}.json", self.folder / f"{name}.job"
        text = json.dumps(spec, indent=1)
        if not (job.exists() and job.read_text() == text and (out / "report.json").exists()):
            if job.exists() and job.read_text() != text:
                raise SystemExit(f"bench: {job} is of another measurement; remove {self.folder}")
            job.write_text(text)
            roots = f"{os.environ.get('LACUNA_SCENES', '')}:{self.folder / 'pictures'}"
            subprocess.run([self.lacuna, "render", job, "--out", out, "-q"], check=True,
                           env={**os.environ, "LACUNA_SCENES": roots, "LACUNA_DATA": str(self.folder / "data")})
        return json.loads((out / "report.json").read_text())

    def reference(self, name, job, seconds):
        """The name of a picture below the scenes roots, and its variance."""
        report = self.report(f"reference-{name}", {**job, "integrator": {**METHODS["auto"], **LENGTHS},
                                                   "budget": {"cpu_seconds": seconds}, "seed": 1000})
        picture = self.folder / "pictures" / f"{name}.exr"
        if not picture.exists():
            os.link(self.folder / f"reference-{name}.job" / "image.exr", picture)
        return picture.name, (report["errors"]["est_rmse"] or 0) ** 2


def measure(runs, name, seconds, seeds):
    """{method: [(MSE, report) of each seed]}; MSE without the reference's noise, which is None where that is more."""
    job = {**SCENES[name], "resolution": [256, 144]}
    slug = name.replace(", ", "-")
    picture, noise = runs.reference(f"{slug}-{seconds:g}", job, SECONDS_OF_A_REFERENCE * seconds)
    found = {}
    for method, integrator in METHODS.items():
        for seed in range(1, seeds + 1):
            spec = {**job, "integrator": {**integrator, **LENGTHS}, "budget": {"cpu_seconds": seconds}, "seed": seed,
                    "reference": picture}
            report = runs.report(f"{slug}-{seconds:g}-{method.replace(', ', '-')}-{seed}", spec)
            mse = report["errors"]["mse"] - noise
            found.setdefault(method, []).append((mse if mse > noise else None, report))
    return found


def chosen(report):
    return " + ".join(c["name"] for c in report["race"]["candidates"] if c["in_use"])


def geometric(values):
    known = [math.log(v) for v in values if v is not None]
    return math.exp(statistics.mean(known)) if known else None


def row(found):
    """Of a scene: MSE of each method, the best of the fixed ones, and the regret."""
    errors = {method: geometric(mse for mse, _ in runs) for method, runs in found.items()}
    fixed = {m: e for m, e in errors.items() if m != "auto" and e is not None}
    best = min(fixed, key=fixed.get) if fixed else None
    regret = errors["auto"] / fixed[best] if best and errors["auto"] else None
    return errors, best, regret


def told(found):
    """Of each run of `auto`: the expected error over the true one, and whether it said that it is sure."""
    for mse, report in found["auto"]:
        expected = report["race"]["plan"]["expected_rmse"]
        if mse and expected:
            sure = all(c.get("tail_known") is not False and not c.get("unexplained", False)
                       for c in report["race"]["candidates"] if c["in_use"])
            yield expected / math.sqrt(mse), sure


def measure_all(bench, binaries, folder, options):
    runs = Runs(binaries / "lacuna", folder)
    seconds, seeds = options.regret_seconds, options.regret_seeds
    rows, estimates = {}, []
    print(f"MSE over the best fixed method's, {seconds:g} CPU seconds a thread, {seeds} seeds\n")
    print("| scene |", " | ".join(f"`{m}`" for m in METHODS), "| chosen |")
    print("| --- |" + " --- |" * (len(METHODS) + 1))
    for name in options.regret_scenes or SCENES:
        found = measure(runs, name, seconds, seeds)
        errors, best, value = rows[name] = row(found)
        estimates += told(found)
        cells = [f"{'**' if m == best else ''}{e / errors[best]:.2g}{'**' if m == best else ''}" if e else "?"
                 for m, e in errors.items()]
        print(f"| {name} |", " | ".join(cells), "|", "; ".join(sorted({chosen(r) for _, r in found["auto"]})), "|", flush=True)
    print()
    judge(bench, rows, estimates, seconds)


def judge(bench, rows, estimates, seconds):
    regrets = {name: value for name, (_, _, value) in rows.items() if value}
    if not regrets:
        return
    bound = 1.03 if seconds >= 100 else 1.10
    value = geometric(regrets.values())
    bench.figure("regret, geometric mean", f"{value:.3f}", f"at most {bound}", value <= bound)
    worst = max(regrets, key=regrets.get)
    bench.figure("regret, worst", f"{regrets[worst]:.2f}", f"at most 1.5 ({worst})", regrets[worst] <= 1.5)
    won = sum(value < 1 for value in regrets.values())
    bench.figure("scenes where `auto` beats every fixed method", f"{won} of {len(regrets)}", "at least 3", won >= 3)
    gains = {}
    for single in SINGLES:
        ratios = [errors[single] / errors["auto"] for errors, _, _ in rows.values() if errors[single] and errors["auto"]]
        gains[single] = geometric(ratios)
    least = min(gains, key=gains.get)
    bench.figure(f"gain over always `{least}`, geometric mean", f"{gains[least]:.2f}", "at least 1.5", gains[least] >= 1.5)
    good = sum(not sure or 1 / 1.5 <= ratio <= 1.5 for ratio, sure in estimates)
    unsure = sum(not sure for _, sure in estimates)
    bench.figure("expected error within 1.5 of the true one, or not sure", f"{good} of {len(estimates)}",
                 f"nine in ten; not sure: {unsure}", good >= 0.9 * len(estimates))
