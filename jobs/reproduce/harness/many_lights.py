"""What the entries of Nabata et al. have in common: many lights on crops of 512 x 512 pixels. A crop keeps what the ratios
depend on, the number of lights and the pixels of a cache point, and takes a part of the time."""

import statistics

from harness import child, layers
from harness.measured import geometric_mean_of, mean_of

FULL = [512, 512]
# The lights that a light path gives, measured, decide how many paths the paper's number of lights takes. San Miguel, the
# museum and the hairball are not ours to have; `stand-in` names what is rendered in their place: a court with plants and sun, a room
# with furniture that is lit through a door, and hair of our own making in as many triangles.
SCENES = {
    "San Miguel": {"scene": "atrium.glb", "camera": "court", "lights": 550_000, "paths": 329_000, "cache": 1885,
                   "crop": [200, 260], "stand-in": "atrium.glb"},
    "Hairball": {"scene": "hairball_2800k.glb", "camera": "front", "lights": 100_000, "paths": 25_450, "cache": 500,
                 "crop": [350, 170], "stand-in": "hairball_2800k.glb"},
    "Sponza": {"scene": "sponza/scene.glb", "camera": "atrium", "lights": 300_000, "paths": 285_000, "cache": 1414,
               "crop": [200, 260]},
    "Museum": {"scene": "door/scene.glb", "camera": "corner", "lights": 100_000, "paths": 25_000, "cache": 1900,
               "crop": [200, 200], "stand-in": "door/scene.glb"},
}
TESTS = "visibility_tests"


def shown(scene):
    """The scene's name, and what stands in for it."""
    other = SCENES[scene].get("stand-in")
    return f"{scene} (stand-in: {other})" if other else scene


def visibility(name, cache_points=None, **more):
    value = {"type": name, **more}
    if cache_points is not None:
        value["cache_points"] = cache_points
    return value


def published(name, cache_points=None):
    """A visibility as published: only rays cost time, the variance that cache points have stored, a random number for each
    light, all lights at cache points, and no pixel below 0 (sections 3.1 to 4.2). Of Veach's roulette, what of these it has."""
    return visibility(name, cache_points, **({} if name == "interpolated" else {"as": "published"}))


def job(scene, how, full, share=1.0, side=64, **more):
    """One iteration of `share` of the paper's lights; `side`: pixels along a side of the crop, where not `full`."""
    s = SCENES[scene]
    value = {"scene": s["scene"], "camera": s["camera"], "budget": {"iterations": 1}, "checkpoint_seconds": 86400,
             "integrator": {"type": "many_lights", "max_depth": 6, "light_paths": round(s["paths"] * share),
                            "compensation": False, "visibility": how},
             "resolution": FULL if full else [side, side], **more}
    if full:
        value.pop("crop", None)
    else:
        value.setdefault("crop", {"of": FULL, "from": s["crop"]})
    return value


def cached(scene, full, side=64):
    """Cache points of the paper, as many as fall to the crop."""
    points = SCENES[scene]["cache"]
    return points if full else max(3, round(points * side * side / (FULL[0] * FULL[1])))


def render(run, name, value):
    """Run.render(): a job's report."""
    return run.render(name, value)


def seconds(report):
    return report["seconds"]["render_cpu"]


def errors(run, name, exact_name, *options):
    """Every error of one picture against another of the same lights, as `lacuna compare` prints them."""
    pictures = [run.place(which) / "image.exr" for which in (name, exact_name)]
    lines = child.lacuna("compare", *pictures, *options)[0].splitlines()
    return {words[0]: float(words[1]) for words in map(str.split, lines) if len(words) == 2}


def tests(run, name, exact_name):
    """The share of *all* lights that a shading point tests, as the paper counts; shading points are the pixels at which
    exact visibility tests any. Both jobs have the layer TESTS."""
    own, exact = (layers.channels(run.place(which), TESTS)[0] for which in (name, exact_name))
    return statistics.fmean(t for t, e in zip(own, exact) if e > 0)


class Comparison:
    """Visibilities with the same lights as `exact`, for a few seeds; `how`: their names and settings. Takes what job()
    takes of the jobs."""

    def __init__(self, run, scene, how, seeds, **more):
        self.run, self.scene, self.seeds, self.how = run, scene, seeds, {"exact": visibility("exact"), **how}
        self.reports = {key: run.repeated(f"{scene}-{key}", job(scene, value, run.full, layers=[TESTS], **more), seeds)
                        for key, value in self.how.items()}

    def name(self, key, seed):
        """Of Run.place()."""
        return f"{self.scene}-{key}-{seed}"

    def lights(self):
        return self.reports["exact"][0]["integrator"]["virtual_lights"]

    def seconds(self, key):
        return mean_of([seconds(r) for r in self.reports[key]])

    def speed_up(self, key, over="exact"):
        """Seconds of `over` / of `key`, by seeds."""
        return geometric_mean_of([seconds(a) / seconds(b) for a, b in zip(self.reports[over], self.reports[key])])

    def saved(self, key):
        """The share of all lights that a shading point does not test."""
        return mean_of([1 - tests(self.run, self.name(key, s), self.name("exact", s)) for s in range(self.seeds)])

    def tests_over(self, key, other):
        """The tests of a shading point, over those of another method."""
        share = {k: [tests(self.run, self.name(k, s), self.name("exact", s)) for s in range(self.seeds)] for k in (key, other)}
        return geometric_mean_of([a / b for a, b in zip(share[key], share[other])])

    def cost_over(self, key, other, of_time=1):
        """Squared error times seconds to the power `of_time`, over those of another method, by seeds."""
        cost = {k: [e["mse"] * seconds(r) ** of_time for e, r in zip(self.errors(k), self.reports[k])] for k in (key, other)}
        return geometric_mean_of([a / b for a, b in zip(cost[key], cost[other])])

    def errors(self, key, *options):
        """Those of every seed against exact visibility."""
        return [errors(self.run, self.name(key, s), self.name("exact", s), *options) for s in range(self.seeds)]
