"""What the tables and figures of Noel 2015, chapter 11, have in common: bidirectional path tracing on the thesis' scenes
that this project has, with every kind of connections, at the thesis' settings and at the project's."""

from harness.measured import error_at, gain_at, speed_up_to, time_to
from harness.run import Table, cell_with

CONNECTIONS = "/integrator/connections"
SCENES = {
    "door": {"/scene": "door/scene.glb", "/camera": "corner", "/resolution": [1024, 512], "/reference": "auto"},
    "sponza": {"/scene": "sponza/scene.glb", "/camera": "directional-light-from-power", "/resolution": [1024, 512],
               "/reference": "auto"},
    "corridor": {"/scene": "corridor/scene.glb", "/camera": "far-from-light", "/resolution": [512, 512],
                 "/reference": "corridor/reference.exr"},
}
PAIRED = {"type": "paired"}
UNIFORM = {"type": "uniform"}
CACHE = {"type": "importance_cache"}
SKELETON = {"type": "skeleton"}
THESIS = {"count_as": 0, "combination": "max"}  # 11.3 and 11.5
METHODS = {"paired": PAIRED, "uniform": UNIFORM, "importance cache": CACHE, "skeleton": SKELETON,
           "importance cache, thesis": {**CACHE, **THESIS}, "skeleton, thesis": {**SKELETON, **THESIS}}


def sweep(full, scenes, methods):
    """The value of a sweep file. `cpu_seconds` are the clock: they hold on a busy machine, too."""
    pointers = list(SCENES["door"])
    return {
        "label": "connections of bidirectional path tracing",
        "job": {"integrator": {"type": "bdpt", "max_depth": 6}, "analysis": {"resolution": 128},
                "budget": {"cpu_seconds": 600 if full else 20}, "reference_iterations": 4000 if full else 300},
        "axes": {CONNECTIONS: list(methods.values())},
        "zip": [{pointer: [SCENES[s][pointer] for s in scenes] for pointer in pointers}],
        "seeds": 3,
        "baseline": {CONNECTIONS: PAIRED},
        "compare_at": {"clock": "cpu_seconds", "metric": "mae"},
    }


def cell(answers, scene, connections):
    return cell_with(answers, scene=SCENES[scene]["/scene"], connections=connections)


def tables(answers, scenes, methods):
    """Of each scene: what every method reached."""
    return [Table((scene, "MAE at equal time", "gain", "time to equal MAE", "speed-up"), [
        (name, *map(str, (error_at(c["at"][-1]), gain_at(c["at"][-1]), time_to(c["to"][-1]), speed_up_to(c["to"][-1]))))
        for name, c in ((name, cell(answers, scene, value)) for name, value in methods.items())]) for scene in scenes]
