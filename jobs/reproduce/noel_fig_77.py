"""Noel 2015, Fig. 77: rays guided by the skeleton against BSDF sampling, at equal time; beside them rays through portals
and faces (chapter 10), and learned path guiding (the SD-tree), which the thesis planned to compare and did not."""

from harness import noel_paths
from harness.measured import error_at, gain_at
from harness.run import Table, cell_with

GUIDE = "/integrator/guide"
SCENES = {
    "corridor": {"/scene": "corridor/scene.glb", "/camera": "far-from-light", "/resolution": [512, 512],
                 "/reference": "corridor/reference.exr"},
    "door": {"/scene": "door/scene.glb", "/camera": "corner", "/resolution": [1024, 512], "/reference": "auto"},
    "sponza": {"/scene": "sponza/scene.glb", "/camera": "directional-light-from-power", "/resolution": [1024, 512],
               "/reference": "auto"},
    "atrium": {"/scene": "sponza/scene.glb", "/camera": "atrium", "/resolution": [1024, 512], "/reference": "auto"},
    # As the thesis tells of them (9.3): two small lights that few surfaces see; a glossy floor, lit from the other aisle.
    "sponza plugging": {"/scene": "sponza/scene.glb", "/camera": "atrium", "/resolution": [1024, 512],
                        "/reference": "auto", "/particles": {"count": 2, "power": 3e7, "low": [0.15, 0.15, 0.74],
                                                             "high": [0.85, 0.2, 0.76], "seed": 3, "alone": True}},
    "sponza glossy": {"/scene": "sponza/scene.glb", "/camera": "directional-light-from-power",
                      "/resolution": [1024, 512], "/reference": "auto",
                      "/material": {"name": "floor", "roughness": 0.2},
                      "/particles": {"count": 1, "power": 6e7, "low": [0.3, 0.15, 0.26], "high": [0.35, 0.2, 0.28],
                                     "alone": True}},
}
POINTERS = ("/scene", "/camera", "/resolution", "/reference", "/particles", "/material")
CLAIMED = ("corridor", "sponza plugging", "sponza glossy")
BSDF = {"type": "bsdf"}
STRENGTHS = (2, 8, 16, 32, 128)


def skeleton(strength, **more):
    return {"type": "skeleton", "strength": strength, **more}


GUIDES = {
    "BSDF": BSDF,
    **{f"skeleton, s = {s}": skeleton(s) for s in STRENGTHS},
    "skeleton, s = 16, thesis' points": skeleton(16, aim="mean"),
    "skeleton, auto": skeleton("auto"),
    "skeleton, both auto": skeleton("auto", probability="auto"),
    "portals": {"type": "portals"},
    "face irradiance": {"type": "face_irradiance"},
    "SD-tree": {"type": "sd_tree"},
}


def sweep(full):
    """CPU seconds are the clock: they hold on a busy machine, too."""
    smaller = 1 if full else 4

    def value(scene, pointer):
        found = SCENES[scene].get(pointer)
        if pointer == "/resolution" and SCENES[scene]["/reference"] == "auto":
            return [side // smaller for side in found]
        return found

    return {
        "label": "guided rays",
        "job": {"integrator": {"type": "path", "max_depth": 6}, "analysis": {"resolution": 128},
                "budget": {"cpu_seconds": 300 if full else 6}, "reference_iterations": 4000 if full else 300},
        "axes": {GUIDE: list(GUIDES.values())},
        "zip": [{pointer: [value(scene, pointer) for scene in SCENES] for pointer in POINTERS}],
        "seeds": 5 if full else 2,
        "baseline": {GUIDE: BSDF},
        "compare_at": {"clock": "cpu_seconds", "metric": "mse"},
    }


def cell(answers, scene, guide):
    where = {pointer: SCENES[scene].get(pointer) for pointer in ("/scene", "/camera", "/particles", "/material")}
    return cell_with(answers, guide=guide, **{pointer.lstrip("/"): value for pointer, value in where.items()})


def best(cells):
    """The name of the fixed strength with the least error at the end."""
    fixed = {name: c for name, c in cells.items() if "s = " in name and "thesis" not in name}
    return min(fixed, key=lambda name: error_at(fixed[name]["at"][-1]).value)


def measure(run):
    answers = run.answers(sweep(run.full))
    for scene in SCENES:
        cells = {name: cell(answers, scene, guide) for name, guide in GUIDES.items()}
        run.tables.append(Table((scene, *(f"gain at {at['seconds']:.3g} s" for at in cells["BSDF"]["at"]), "MSE"), [
            (name, *(str(gain_at(at)) for at in c["at"]), str(error_at(c["at"][-1]))) for name, c in cells.items()]))
        strongest = best(cells)
        auto = error_at(cells["skeleton, auto"]["at"][-1]).value / error_at(cells[strongest]["at"][-1]).value
        run.note(f"{scene}: best fixed strength: {strongest}; MSE of auto / of it: {auto:.2f}")
        if scene in CLAIMED:
            run.found(f"{scene}: {noel_paths.GAIN}", gain_at(cells[strongest]["at"][-1]))
    run.note("MSE; seconds: CPU seconds of a core, without the preparation, which a cache keeps (lacuna report)")
    run.note("the plants and the apartment are not among the scenes")
