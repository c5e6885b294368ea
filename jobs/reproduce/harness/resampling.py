"""What the tables and figures of Noel 2015, chapter 11, have in common: bidirectional path tracing on the thesis' scenes
that this project has, with every kind of connections, at the project's settings and at the thesis'."""

from harness.measured import error_at, gain_at, speed_up_to, time_to
from harness.run import Table, cell_with

DEPTH = 6  # edges
SCENES = {
    "door": {"/scene": "door/scene.glb", "/camera": "corner", "/resolution": [1024, 512], "/reference": "auto"},
    "sponza": {"/scene": "sponza/scene.glb", "/camera": "directional-light-from-power", "/resolution": [1024, 512],
               "/reference": "auto"},
    "corridor": {"/scene": "corridor/scene.glb", "/camera": "far-from-light", "/resolution": [512, 512],
                 "/reference": "corridor/reference.exr"},
}


def bdpt(connections, **more):
    return {"type": "bdpt", "max_depth": DEPTH, "connections": connections, **more}


OURS = {"BPT": bdpt({"type": "paired"}), "ICBPT": bdpt({"type": "importance_cache"}),
        "SkelBPT": bdpt({"type": "skeleton"}), "uniform": bdpt({"type": "uniform"})}


def as_published(connections):
    """11.3 to 11.5, and what is known of the author's code: no roulette anywhere, every light path joined to the eye."""
    resampling = {"count_as": 0, "combination": "max", "roulette": 0, "splat_paths": 1}
    return bdpt({"type": connections, **(resampling if connections != "paired" else {})}, roulette_depth=DEPTH)


THESIS = {"BPT": as_published("paired"), "ICBPT": as_published("importance_cache"),
          "SkelBPT": as_published("skeleton")}


def sweep(full, methods, scenes=tuple(SCENES), seeds=3):
    """The value of a sweep file; the first of the methods is the baseline. CPU seconds are the clock: they hold on a busy
    machine, too."""
    return {
        "label": "connections of bidirectional path tracing",
        "job": {"analysis": {"resolution": 128}, "budget": {"cpu_seconds": 300 if full else 15},
                "reference_iterations": 4000 if full else 64},
        "axes": {"/integrator": list(methods.values())},
        "zip": [{pointer: [SCENES[s][pointer] for s in scenes] for pointer in SCENES["door"]}],
        "seeds": seeds,
        "baseline": {"/integrator": next(iter(methods.values()))},
        "compare_at": {"clock": "cpu_seconds", "metric": "mae"},
    }


def ours(run):
    """The answers to all methods on all scenes, which several entries share."""
    return run.answers(sweep(run.full, OURS), shared="noel-resampling")


def cell(answers, scene, integrator):
    return cell_with(answers, scene=SCENES[scene]["/scene"], integrator=integrator)


def table(answers, scene, methods, title=""):
    """What every method reached on a scene."""
    return Table((scene + title, "MAE at equal time", "gain", "time to equal MAE", "speed-up"), [
        (name, *map(str, (error_at(c["at"][-1]), gain_at(c["at"][-1]), time_to(c["to"][-1]), speed_up_to(c["to"][-1]))))
        for name, c in ((name, cell(answers, scene, value)) for name, value in methods.items())])


def measure_errors(run, scene):
    """Figs 98 and 99: the errors at equal time, as ratios to that of SkelBPT."""
    answers = ours(run)
    at = {name: cell(answers, scene, value)["at"][-1] for name, value in OURS.items()}
    best = error_at(at["SkelBPT"])
    run.found("error of BPT / of SkelBPT", gain_at(at["SkelBPT"]))
    cached = error_at(at["ICBPT"])
    run.found("error of ICBPT / of SkelBPT", cached and best and cached.ratio(best))
    run.tables.append(table(answers, scene, OURS))
    run.note(f"MAE after {at['BPT']['seconds']:.3g} CPU seconds, {answers['seeds']} runs each; pictures: {run.runs}")
