"""Guided rays."""

from harness.entry import Entries
from harness.measured import error_at, gain_at, geometric_mean_of
from harness.run import Table, cell_with
from harness.verdict import at_least, at_most, beside

ENTRIES = Entries()
SKELETON_GUIDE = "path with guide: skeleton"
GAIN = "error of BSDF sampling / of ours, at equal time"
BSDF = {"type": "bsdf"}
GUIDE = "/integrator/guide"


def measure_iterations(run, guides, quantity):
    """Errors after as many iterations of each guide. `quantity`: the first one's gain over BSDF sampling."""
    iterations = 4096 if run.full else 32
    answers = run.answers({
        "label": "guides at equal iterations",
        "job": {"scene": "door/scene.glb", "camera": "corner", "resolution": [1024, 512] if run.full else [256, 128],
                "integrator": {"type": "path", "max_depth": 6}, "analysis": {"resolution": 128},
                "budget": {"iterations": iterations}, "reference": "auto",
                "reference_iterations": 4000 if run.full else 1000},
        "axes": {GUIDE: [BSDF, *guides.values()]},
        "seeds": 5 if run.full else 3,
    })

    def told(guide):
        return [run.report(cell_with(answers, guide=guide), seed) for seed in range(answers["seeds"])]

    plain = told(BSDF)
    rows = []
    for name, guide in guides.items():
        own = told(guide)

        def gain(value, own=own):
            return geometric_mean_of([value(a) / value(b) for a, b in zip(plain, own)])

        gains = [gain(lambda r, m=metric: r["errors"][m]) for metric in ("mae", "rmse", "relmse")]
        cost = gain(lambda r: r["seconds"]["render_cpu"])
        if not rows:
            run.found(quantity, gains[0])
        rows.append((name, *map(str, gains), f"{1 / cost.value:.3g}"))
    run.tables.append(Table(("door", "gain in MAE", "in RMSE", "in relMSE", "time of an iteration"), rows))
    run.note(f"{iterations} iterations; means of {answers['seeds']} runs")


def guided(number, page, configuration, minutes, *more):
    return (f"noel-fig-{number}", f"Noel 2015, Fig. {number}, p. {page}",
            f"{configuration}: lower error than BSDF sampling after {minutes} min", SKELETON_GUIDE,
            (at_least(GAIN, 1), *more))


ENTRIES.planned(*guided(71, 132, "corridor, diffuse, s = 16", 20, beside("iterations, BSDF sampling", 10694),
                        beside("iterations, s = 16", 4513), beside("iterations, s = 1", 8307)))
ENTRIES.planned(*guided(72, 133, "sponza plugging, s = 8", 30))
ENTRIES.planned(*guided(73, 134, "sponza glossy", 30))
ENTRIES.planned(*guided(74, 135, "plants", 60))
ENTRIES.planned(*guided(75, 136, "apartment", 60))

ENTRIES.planned(
    "noel-fig-76", "Noel 2015, Fig. 76, p. 137",
    "sponza dark after 15 min: a larger strength lessens noise in one part and adds it in another",
    SKELETON_GUIDE, (at_least("blue frame: error at least strength / at largest", 1),
                     at_most("red frame: error at least strength / at largest", 1)))


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
STRENGTHS = (2, 8, 16, 32, 128)


def skeleton(strength, **more):
    return {"type": "skeleton", "strength": strength, "probability": 0.5, **more}


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


def fig_77_sweep(full):
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


@ENTRIES.measured(
    "noel-fig-77", "Noel 2015, Fig. 77, p. 138", "convergence: lower error in every configuration",
    SKELETON_GUIDE, tuple(at_least(f"{c}: {GAIN}", 1) for c in (
        "corridor", "sponza plugging", "sponza glossy", "plants", "apartment", "sponza dark")),
    sweep=fig_77_sweep)
def fig_77(run):
    """Rays guided by the skeleton against BSDF sampling, at equal time; beside them rays through portals
    and faces (chapter 10), and learned path guiding (the SD-tree), which the thesis planned to compare and did not."""
    answers = run.answers(fig_77_sweep(run.full))
    for scene in SCENES:
        cells = {name: cell(answers, scene, guide) for name, guide in GUIDES.items()}
        run.tables.append(Table((scene, *(f"gain at {at['seconds']:.3g} s" for at in cells["BSDF"]["at"]), "MSE"), [
            (name, *(str(gain_at(at)) for at in c["at"]), str(error_at(c["at"][-1]))) for name, c in cells.items()]))
        strongest = best(cells)
        auto = error_at(cells["skeleton, auto"]["at"][-1]).value / error_at(cells[strongest]["at"][-1]).value
        run.note(f"{scene}: best fixed strength: {strongest}; MSE of auto / of it: {auto:.2f}")
        if scene in CLAIMED:
            run.found(f"{scene}: {GAIN}", gain_at(cells[strongest]["at"][-1]))
    run.note("MSE; seconds: CPU seconds of a core, without the preparation, which a cache keeps (lacuna report)")
    run.note("the plants and the apartment are not among the scenes")


@ENTRIES.measured(
    "noel-fig-91", "Noel 2015, Fig. 91, p. 155",
    "door, rays through portals: less noise than BSDF sampling after 4096 iterations", "path with guide: portals",
    (at_least("error of BSDF sampling / of portals, at equal iterations", 1),))
def fig_91(run):
    """Rays through portals against BSDF sampling on door, after as many iterations of each."""
    measure_iterations(run, {"portals": {"type": "portals", "probability": 0.5}, "portals, learned": {"type": "portals"}},
                              "error of BSDF sampling / of portals, at equal iterations")


@ENTRIES.measured(
    "noel-fig-94", "Noel 2015, Fig. 94, p. 158 (too bright there: section 10.4.2)",
    "door, face irradiance: less noise than BSDF sampling after 4096 iterations",
    "path with guide: face_irradiance",
    (at_least("error of BSDF sampling / of face irradiance, at equal iterations", 1),))
def fig_94(run):
    """Rays towards bright faces against BSDF sampling on door, after as many iterations of each. The
    thesis' pictures are too bright; ours have the densities that it got wrong (10.4.2)."""
    measure_iterations(run, {"face irradiance": {"type": "face_irradiance", "probability": 0.5},
                                    "face irradiance, learned": {"type": "face_irradiance"}},
                              "error of BSDF sampling / of face irradiance, at equal iterations")
