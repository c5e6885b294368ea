"""Resampled connections. Every entry renders by bidirectional path tracing on the thesis' scenes
that this project has, with every kind of connections, at the thesis' settings (`published`) and at the project's
(`ours`)."""

from harness.entry import Entries
from harness.measured import error_at, gain_at, geometric_mean_of, speed_up_to, time_to
from harness.run import AS, KINDS, Table, cell_with
from harness.verdict import at_least, near

ENTRIES = Entries()
RESAMPLING = "bdpt with connections: skeleton, importance_cache"
COUNTS = ("MIS weights count all 1024 samples of a connection (11.5), though they share light paths. With `count_as` 8 and all "
          "else as published, MAE after 3 CPU seconds on door is 0.066; as published 0.079, of BPT 0.070 (two seeds)")
BPT = at_least("error of BPT / of SkelBPT", 1, why=COUNTS)
ICBPT = at_least("error of ICBPT / of SkelBPT", 1)
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
    """11.2 to 11.5, and what is known of the author's code: all samples counted, no roulette anywhere, every light path
    joined to the eye, the max heuristic over all distributions."""
    return bdpt({"type": connections}, roulette_depth=DEPTH, **AS["published"])


# Importance caching had two distributions in the author's runs, F and C.
THESIS = {"BPT": as_published("paired"), "ICBPT": as_published("importance_cache"), "SkelBPT": as_published("skeleton"),
          "uniform": as_published("uniform")}


def equal_work(connections):
    """This project's distributions and counts, with as many paths and connections an iteration as all others."""
    resampling = {"roulette": 0, "splat_paths": 1} if connections != "paired" else {}
    return bdpt({"type": connections, **resampling}, roulette_depth=DEPTH)


METHODS = {"published": THESIS, "ours": OURS}


def smaller(scene, full):
    """A scene of a sweep in a sixteenth of the pixels, where there is little time. The light paths are as many: what an
    iteration spends on distributions over them weighs more than in a large picture."""
    return scene if full else {**scene, "/resolution": [side // 4 for side in scene["/resolution"]], "/reference": "auto"}


def with_scenes(value, scenes, full):
    """A sweep on these scenes, in its quick form on smaller pictures and in less time."""
    value["job"] |= {"budget": {"cpu_seconds": 300 if full else 3}, "reference_iterations": 4000 if full else 160}
    small = [smaller(s, full) for s in scenes]
    value["zip"] = [{pointer: [s[pointer] for s in small] for pointer in small[0]}]
    return value


def resampling_sweep(full, methods, scenes, seeds=3, which="ours"):
    """The value of a sweep file; the first of the methods is the baseline. CPU seconds are the clock: they hold on a busy
    machine, too. `which`: whose settings the job has, besides those of the methods."""
    return with_scenes({
        "label": "connections of bidirectional path tracing",
        "job": {"analysis": {"resolution": 128}, **AS[which]},
        "axes": {"/integrator": list(methods.values())},
        "seeds": seeds,
        "baseline": {"/integrator": next(iter(methods.values()))},
        "compare_at": {"clock": "cpu_seconds", "metric": "mae"},
    }, scenes, full)


RESAMPLED = ("door", "sponza")


def all_methods(run, which):
    """The answers to all methods at the settings of `which` row, which several entries share."""
    sweep = resampling_sweep(run.full, METHODS[which], [SCENES[s] for s in RESAMPLED], which=which)
    return run.answers(sweep, shared=f"noel-resampling-{which}")


def resampled_cell(answers, scene, integrator):
    return cell_with(answers, scene=SCENES[scene]["/scene"], integrator=integrator)


def resampled_table(answers, scene, methods, title=""):
    """What every method reached on a scene."""
    return Table((scene + title, "MAE at equal time", "gain", "time to equal MAE", "speed-up"), [
        (name, *map(str, (error_at(c["at"][-1]), gain_at(c["at"][-1]), time_to(c["to"][-1]), speed_up_to(c["to"][-1]))))
        for name, c in ((name, resampled_cell(answers, scene, value)) for name, value in methods.items())])


def show_pictures(run, which, cells):
    """Of BPT, SkelBPT and ICBPT, as the thesis' figures have them, as far as there are cells of them."""
    for name in ("BPT", "SkelBPT", "ICBPT"):
        if name in cells:
            run.show(f"{name}, {which}", run.run_folder(cells[name]))


def measure_errors(run, scene):
    """Figs 98 and 99: the errors at equal time, as ratios to that of SkelBPT."""
    for which in KINDS:
        answers = all_methods(run, which)
        at = {name: resampled_cell(answers, scene, value)["at"][-1] for name, value in METHODS[which].items()}
        best = error_at(at["SkelBPT"])
        run.found("error of BPT / of SkelBPT", **{which: gain_at(at["SkelBPT"])})
        cached = error_at(at["ICBPT"])
        run.found("error of ICBPT / of SkelBPT", **{which: cached and best and cached.ratio(best)})
        run.tables.append(resampled_table(answers, scene, METHODS[which], f", {which}"))
        run.note(f"{which}: MAE after {at['BPT']['seconds']:.3g} CPU seconds, {answers['seeds']} runs each")
        show_pictures(run, which, {name: resampled_cell(answers, scene, value) for name, value in METHODS[which].items()})


def resampled(number, page, configuration, seconds, *claims):
    return (f"noel-fig-{number}", f"Noel 2015, Fig. {number}, p. {page}",
            f"{configuration}: error after {seconds} s of BPT, SkelBPT and ICBPT", RESAMPLING, claims)


@ENTRIES.measured(*resampled(98, 171, "door", 300, BPT, ICBPT))
def fig_98(run):
    """BPT, SkelBPT and ICBPT on door at equal time."""
    measure_errors(run, "door")


@ENTRIES.measured(*resampled(99, 172, "sponza", 300, BPT, ICBPT))
def fig_99(run):
    """BPT, SkelBPT and ICBPT on sponza at equal time."""
    measure_errors(run, "sponza")


@ENTRIES.measured(
    "noel-fig-103", "Noel 2015, Fig. 103, p. 176",
    "L1 error curves of 300 s: SkelBPT below BPT on door and sponza, the same on sibenik", RESAMPLING, (
        at_least("Door: error of BPT / of SkelBPT", 1, why=COUNTS), at_least("Sponza: error of BPT / of SkelBPT", 1)))
def fig_103(run):
    """L1 error against time."""
    for which in KINDS:
        answers = all_methods(run, which)
        for name in ("Door", "Sponza"):
            cells = {method: resampled_cell(answers, name.lower(), value) for method, value in METHODS[which].items()}
            run.found(f"{name}: error of BPT / of SkelBPT", **{which: gain_at(cells["SkelBPT"]["at"][-1])})
            run.tables.append(Table((f"{name}, {which}, CPU seconds", *cells), [
                (f"{at['seconds']:.3g}", *(str(error_at(c["at"][i])) for c in cells.values()))
                for i, at in enumerate(cells["BPT"]["at"])]))
    run.note(f"MAE, {answers['seeds']} runs each; the curves: lacuna report of the sweeps")


# Fig. 96: BPT and SkelBPT where draperies stand between the eye and most of the light. Which view it is the thesis does not
# say; this one is of ours.
DRAPES = {"/scene": "sponza/scene.glb", "/camera": {"position": [200, 190, 480], "target": [1100, 170, 400], "fov": 50},
          "/resolution": [1024, 512], "/reference": "auto"}
TWO = ("BPT", "SkelBPT")


def fig_96_sweep(full, which="published"):
    two = {name: METHODS[which][name] for name in TWO}
    value = resampling_sweep(full, two, [DRAPES], seeds=5 if full else 3, which=which)
    value["job"]["budget"] = {"cpu_seconds": 60 if full else 4}
    return value


@ENTRIES.measured(
    "noel-fig-96", "Noel 2015, Fig. 96, p. 161",
    "behind draperies that hide most light vertices SkelBPT has less noise than BPT after 60 s", RESAMPLING,
    (at_least(BPT.quantity, 1),), sweep=fig_96_sweep)
def fig_96(run):
    """BPT and SkelBPT on sponza behind the drapes at equal time."""
    for which in KINDS:
        answers = run.answers(fig_96_sweep(run.full, which))
        cells = {name: cell_with(answers, integrator=METHODS[which][name]) for name in TWO}
        show_pictures(run, which, cells)
        at = {name: cell["at"][-1] for name, cell in cells.items()}
        run.found(BPT.quantity, **{which: gain_at(at["SkelBPT"])})
        run.tables.append(Table((f"drapes, {which}", "MAE"), [(name, str(error_at(a))) for name, a in at.items()]))
        run.note(f"{which}: MAE after {at['BPT']['seconds']:.3g} CPU seconds, {answers['seeds']} runs each")
    run.note("the thesis names no view: this one of ours looks along an arcade of sponza behind its drapes")


FIG_105 = {"published": {name: THESIS[name] for name in ("BPT", "ICBPT", "SkelBPT")},
           "ours": {"BPT": equal_work("paired"), "ICBPT": equal_work("importance_cache"),
                    "SkelBPT": equal_work("skeleton")}}


def fig_105_sweep(full, which="published"):
    value = resampling_sweep(full, FIG_105[which], [SCENES["door"]], seeds=6, which=which)
    value["job"]["budget"] = {"iterations": 64 if full else 8}
    return value


@ENTRIES.measured(
    "noel-fig-105", "Noel 2015, Fig. 105, p. 178",
    "after 64 iterations ICBPT has the lowest error, at about twice the time of BPT", RESAMPLING, (
        at_least("error of BPT / of ICBPT, at equal iterations", 1),
        at_least("error of SkelBPT / of ICBPT, at equal iterations", 1), near("time of ICBPT / of BPT", 2)),
    sweep=fig_105_sweep)
def fig_105(run):
    """Errors and times after as many iterations of each method, each with as many eye paths, light paths and
    connections."""
    for which in KINDS:
        sweep = fig_105_sweep(run.full, which)
        answers = run.answers(sweep)
        cells = {name: resampled_cell(answers, "door", value) for name, value in FIG_105[which].items()}
        reports = {name: [run.report(c, seed) for seed in range(answers["seeds"])] for name, c in cells.items()}

        def ratio(of, to, value, reports=reports):
            return geometric_mean_of([value(a) / value(b) for a, b in zip(reports[of], reports[to])])

        def error(report):
            return report["errors"]["mae"]

        run.found("error of BPT / of ICBPT, at equal iterations", **{which: ratio("BPT", "ICBPT", error)})
        run.found("error of SkelBPT / of ICBPT, at equal iterations", **{which: ratio("SkelBPT", "ICBPT", error)})
        run.found("time of ICBPT / of BPT", **{which: ratio("ICBPT", "BPT", lambda r: r["seconds"]["render_cpu"])})
        run.note(f"{which}: MAE after {sweep['job']['budget']['iterations']} iterations; means of {answers['seeds']} runs")
