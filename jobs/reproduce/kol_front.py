"""What Kol et al. leave open: the trade of the whole picture. Error against time of maps for many lights beside other
visibilities and beside methods without bias, each as this project has it."""

from harness.entry import Entries
from harness.measured import error_at
from harness.run import Table, cell_with
from harness.verdict import beside

ENTRIES = Entries()
LIGHTS = {"type": "many_lights", "max_depth": 6}
METHODS = {  # light paths of an iteration: many where a light costs little
    "view_maps": {**LIGHTS, "light_paths": 8192, "visibility": {"type": "view_maps"}},
    "view_maps, 64 lights a pixel": {**LIGHTS, "light_paths": 65536, "visibility": {"type": "view_maps"},
                                     "gather": {"type": "random", "lights": 64}},
    "probabilistic": {**LIGHTS, "light_paths": 8192, "visibility": {"type": "probabilistic"}},
    "exact": {**LIGHTS, "light_paths": 1000, "visibility": {"type": "exact"}},
    "path": {"type": "path", "max_depth": 6},
    "bdpt": {"type": "bdpt", "max_depth": 6},
}
PARTICLES = {"count": 4096, "power": 3e5, "color": [1, 0.8, 0.5], "low": [0.1, 0.02, 0.15], "high": [0.9, 0.6, 0.85],
             "alone": True}
SCENES = {
    "sponza": {"/scene": "sponza/scene.glb", "/camera": "atrium", "/particles": None},
    "hairball": {"/scene": "hairball_2800k.glb", "/camera": "front", "/particles": None},
    "door": {"/scene": "door/scene.glb", "/camera": "corner", "/particles": None},
    "particles": {"/scene": "sponza/scene.glb", "/camera": "atrium", "/particles": PARTICLES},
}


def front_sweep(full):
    seconds = 120 if full else 4  # where an iteration takes longer, its method has no error yet
    return {
        "label": "the trade of many lights",
        "job": {"resolution": [1024, 512] if full else [192, 96], "reference": "auto",
                "reference_iterations": 4000 if full else 400, "budget": {"cpu_seconds": seconds}},
        "axes": {"/integrator": list(METHODS.values())},
        "zip": [{pointer: [s[pointer] for s in SCENES.values()] for pointer in SCENES["sponza"]}],
        "seeds": 5 if full else 3,
        "baseline": {"/integrator": METHODS["path"]},
        "compare_at": {"clock": "cpu_seconds", "metric": "relmse", "seconds": [seconds / 2**k for k in (4, 3, 2, 1, 0)]},
    }


@ENTRIES.measured(
    "kol-front", "Kol et al. 2018, section 5, which compares no whole pictures at equal time",
    "which method leads at which time: error against time", "many_lights; path; bdpt",
    tuple(beside(f"{scene}: error of path / of view_maps, at equal time") for scene in SCENES), sweep=front_sweep)
def front(run):
    """Error against time of every method on every scene, and which leads."""
    answers = run.answers(front_sweep(run.full))
    for scene, where in SCENES.items():
        cells = {name: cell_with(answers, integrator=value, scene=where["/scene"], particles=where["/particles"])
                 for name, value in METHODS.items()}
        rows = []
        for i, at in enumerate(cells["path"]["at"]):
            errors = {name: error_at(cell["at"][i]) for name, cell in cells.items()}
            known = {name: error for name, error in errors.items() if error is not None}
            rows.append((f"{at['seconds']:.3g}", *(str(errors[name] or "") for name in METHODS),
                         min(known, key=lambda name, known=known: known[name].value) if known else ""))
        run.tables.append(Table((f"{scene}, CPU seconds", *METHODS, "leads"), rows))
        last = {name: error_at(cells[name]["at"][-1]) for name in ("path", "view_maps")}
        run.found(f"{scene}: error of path / of view_maps, at equal time",
                  ours=last["path"] and last["view_maps"] and last["path"].ratio(last["view_maps"]))
    run.note(f"relMSE, {answers['seeds']} runs each; virtual lights with compensation; references by bidirectional path tracing")
