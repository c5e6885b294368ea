"""Resampled connections. Every entry renders by bidirectional path tracing on the thesis' scenes
that this project has, with every kind of connections, at the thesis' settings (`published`) and at the project's
(`ours`)."""

from harness import layers
from harness.entry import Entries
from harness.measured import Measured, error_at, exact, gain_at, geometric_mean_of, mean_of, speed_up_to, time_to
from harness.run import KINDS, Table, cell_with
from harness.verdict import at_least, beside
from noel_shadows import GRID, RADII

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


def as_published(connections, **more):
    """11.2 to 11.5, and what is known of the author's code: all samples counted, no roulette anywhere, every light path
    joined to the eye."""
    resampling = {"count_as": 0, "roulette": 0, "splat_paths": 1, **more}
    return bdpt({"type": connections, **(resampling if connections != "paired" else {})}, roulette_depth=DEPTH)


# The max heuristic over all distributions, and eq. 187 for light vertices of either side.
THESIS = {"BPT": as_published("paired"),
          "ICBPT": as_published("importance_cache", combination="max", unshadowed=True, bounded=True),
          "SkelBPT": as_published("skeleton", combination="max", sides="both"),
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
    machine, too. `which`: whose radius the skeleton's nodes have."""
    return with_scenes({
        "label": "connections of bidirectional path tracing",
        "job": {"analysis": {"resolution": 128, "node_radius": RADII[which]}},
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


SKELETON = OURS["SkelBPT"]


def share_of_distributions(told):
    """Of the CPU seconds of iterations; `told`: the integrator's part of a report."""
    return told["distributions_cpu_seconds"] / sum(
        told[f"{key}_cpu_seconds"] for key in ("light_pass", "distributions", "eye_pass"))


def table_5_sweep(full):
    scenes = (SCENES["door"], SCENES["sponza"], STAND_INS["Sibenik"])
    value = resampling_sweep(full, {"SkelBPT": SKELETON}, scenes, seeds=1)
    del value["compare_at"], value["baseline"], value["job"]["reference_iterations"]
    value["job"]["analysis"] = GRID
    value["axes"]["/analysis/node_radius"] = list(RADII.values())
    value["zip"] = [{pointer: [s[pointer] for s in scenes] for pointer in ("/scene", "/camera", "/resolution")}]
    value["job"]["budget"] = {"iterations": 16 if full else 4}
    return value


@ENTRIES.measured(
    "noel-table-5", "Noel 2015, Table 5, p. 167", "nodes of the filtered skeleton, and nodes used per iteration",
    "bdpt with connections: skeleton",
    (beside("Door, nodes", 74), beside("Door, per iteration", 9), beside("Sponza, nodes", 666),
     beside("Sponza, per iteration", 45), beside("Sibenik, nodes", 1420), beside("Sibenik, per iteration", 85)),
    sweep=table_5_sweep)
def table_5(run):
    """Nodes of the filtered skeleton, and how many of them have distributions in an iteration."""
    answers = run.answers(table_5_sweep(run.full))
    for name, scene in (("Door", SCENES["door"]), ("Sponza", SCENES["sponza"]), ("Sibenik", STAND_INS["Sibenik"])):
        for which, radius in RADII.items():
            told = run.report(cell_with(answers, scene=scene["/scene"], node_radius=radius))["integrator"]
            run.found(f"{name}, nodes", **{which: exact(told["nodes"])})
            run.found(f"{name}, per iteration", **{which: Measured(told["nodes_used"])})
        run.note(f"{name}: the distributions take {share_of_distributions(told):.1%} of an iteration")
    run.note(f"{GRID['resolution']} voxels along the longest side, as in Table 1: the thesis does not tell those of Table 5")
    run.note(f"Sibenik: {STAND_INS['Sibenik']['/scene']}, {STAND_IN}")


def find_times(run, which, name, first, to):
    """The rows of Table 6 of a scene. `to`: of each method its member of `to`; `first`: what the row of BPT is called."""
    for method in ("BPT", "ICBPT", "SkelBPT"):
        run.found(first if method == "BPT" else f"{name}, {method}", **{which: time_to(to[method])})
        if method != "BPT":
            run.found(f"{name}, {method}: speed-up", **{which: speed_up_to(to[method])})


FIRST = {"Door": "Door to 0.01, BPT", "Sponza": "Sponza to 0.15, BPT"}


@ENTRIES.measured(
    "noel-table-6", "Noel 2015, Table 6, p. 169", "time to equal L1 error, and speed-up over BPT", RESAMPLING,
    (beside("Door to 0.01, BPT", 3677.44, "s"), beside("Door, ICBPT", 7095.64, "s"),
     beside("Door, SkelBPT", 2341.36, "s"), beside("Door, ICBPT: speed-up", 0.51),
     at_least("Door, SkelBPT: speed-up", 1.57, why=COUNTS), beside("Sponza to 0.15, BPT", 1910.39, "s"),
     beside("Sponza, ICBPT", 4731.15, "s"), beside("Sponza, SkelBPT", 675.98, "s"),
     beside("Sponza, ICBPT: speed-up", 0.40), at_least("Sponza, SkelBPT: speed-up", 2.82, why=COUNTS),
     at_least("Door, SkelBPT over uniform: speed-up", 1), at_least("Sponza, SkelBPT over uniform: speed-up", 1),
     beside("Sibenik to 0.025, BPT", 1334.48, "s"), beside("Sibenik, ICBPT", 3114.65, "s"),
     beside("Sibenik, SkelBPT", 1298.69, "s"), beside("Sibenik, ICBPT: speed-up", 0.42),
     at_least("Sibenik, SkelBPT: speed-up", 1.02)))
def table_6(run):
    """Time to equal L1 error of bidirectional path tracing with paired connections (BPT), importance caching (ICBPT) and
    the skeleton (SkelBPT); and the skeleton's gain alone, over resampling without any guidance with all else equal."""
    for which in KINDS:
        answers = all_methods(run, which)
        for name, first in FIRST.items():
            to = {method: resampled_cell(answers, name.lower(), value)["to"][-1] for method, value in METHODS[which].items()}
            find_times(run, which, name, first, to)
            plain, guided = time_to(to["uniform"]), time_to(to["SkelBPT"])
            run.found(f"{name}, SkelBPT over uniform: speed-up", **{which: plain and guided and plain.ratio(guided)})
        run.tables += [resampled_table(answers, scene, METHODS[which], f", {which}") for scene in RESAMPLED]
        stand_in = {method: cell["to"][-1] for method, cell in on_stand_in(run, which, "Sibenik").items()}
        find_times(run, which, "Sibenik", "Sibenik to 0.025, BPT", stand_in)
    run.note(f"Sibenik: {STAND_INS['Sibenik']['/scene']}, {STAND_IN}")
    run.note("CPU seconds of a core; equal error: the lowest MAE that every run of a scene reached; "
             f"{answers['seeds']} runs each")


@ENTRIES.measured(*resampled(98, 171, "door", 300, BPT, ICBPT))
def fig_98(run):
    """BPT, SkelBPT and ICBPT on door at equal time."""
    measure_errors(run, "door")


@ENTRIES.measured(*resampled(99, 172, "sponza", 300, BPT, ICBPT))
def fig_99(run):
    """BPT, SkelBPT and ICBPT on sponza at equal time."""
    measure_errors(run, "sponza")


# Scenes of the kind of those that are not to be had (jobs/scenes/stand_ins.py), which are not those.
STAND_INS = {
    "Sibenik": {"/scene": "nave.glb", "/camera": "door", "/resolution": [768, 576], "/reference": "auto"},
    "Apartment": {"/scene": "flat.glb", "/camera": "first room", "/resolution": [768, 576], "/reference": "auto"},
    "Plants": {"/scene": "plants.glb", "/camera": "chair", "/resolution": [768, 576], "/reference": "auto"},
}
STAND_IN = ("stand-in: the thesis' scene is not to be had, and this one is of our own making (jobs/scenes); its numbers are "
            "no reproduction of the paper's")


def stand_in_sweep(full, which="published"):
    three = {name: METHODS[which][name] for name in ("BPT", "ICBPT", "SkelBPT")}
    return resampling_sweep(full, three, STAND_INS.values(), seeds=5 if full else 3, which=which)


def on_stand_in(run, which, name):
    """The cells of the three methods on the stand-in for a scene, and its table."""
    answers = run.answers(stand_in_sweep(run.full, which), shared=f"noel-stand-ins-{which}")
    three = {m: METHODS[which][m] for m in ("BPT", "ICBPT", "SkelBPT")}
    cells = {m: cell_with(answers, scene=STAND_INS[name]["/scene"], integrator=value) for m, value in three.items()}
    run.tables.append(Table((f"{STAND_INS[name]['/scene']}, {which}, CPU seconds", *cells), [
        (f"{at['seconds']:.3g}", *(str(error_at(c["at"][i])) for c in cells.values()))
        for i, at in enumerate(cells["BPT"]["at"])]))
    return cells


def measure_stand_in(run, name):
    for which in KINDS:
        cells = on_stand_in(run, which, name)
        show_pictures(run, which, cells)
        at = {m: c["at"][-1] for m, c in cells.items()}
        best, cached = error_at(at["SkelBPT"]), error_at(at["ICBPT"])
        found = {BPT.quantity: gain_at(at["SkelBPT"]), ICBPT.quantity: cached and best and cached.ratio(best)}
        for claim in run.entry.claims:
            run.found(claim.quantity, **{which: found[claim.quantity]})
    run.note(STAND_IN)


@ENTRIES.measured(*resampled(100, 173, "sibenik (similar to BPT)", 300, ICBPT, beside(BPT.quantity, 1)),
                  sweep=stand_in_sweep)
def fig_100(run):
    """BPT, SkelBPT and ICBPT in a church at equal time."""
    measure_stand_in(run, "Sibenik")


# Why these are missed on stand-ins.
OTHER_ROOMS = "another scene; why importance caching leads in these rooms was not examined"
SHARED_POINTS = ("another scene: bulbs among the leaves light most of the picture directly. BPT draws a new, evenly spread point on an "
                 "emitter at each vertex, resampled connections choose among those that all pixels share: with direct light alone "
                 "(2 edges, 1 CPU second, one run) the ratio is 0.49, too")


@ENTRIES.measured(*resampled(101, 174, "apartment (ICBPT beats BPT, SkelBPT both)", 900, BPT,
                             at_least(ICBPT.quantity, 1, why=OTHER_ROOMS)))
def fig_101(run):
    """BPT, SkelBPT and ICBPT in rooms in a row at equal time."""
    measure_stand_in(run, "Apartment")


@ENTRIES.measured(*resampled(102, 175, "plants (ICBPT and SkelBPT similar, both beat BPT)", 900,
                             at_least(BPT.quantity, 1, why=SHARED_POINTS)))
def fig_102(run):
    """BPT, SkelBPT and ICBPT among leaves at equal time."""
    measure_stand_in(run, "Plants")


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


@ENTRIES.measured(
    "noel-fig-104", "Noel 2015, Fig. 104, p. 177",
    "L1 error curves of 900 s: SkelBPT below BPT on apartment and plants", RESAMPLING, (
        at_least("Apartment: error of BPT / of SkelBPT", 1),
        at_least("Plants: error of BPT / of SkelBPT", 1, why=SHARED_POINTS)))
def fig_104(run):
    """L1 error against time, on stand-ins."""
    for which in KINDS:
        for name in ("Apartment", "Plants"):
            cells = on_stand_in(run, which, name)
            run.found(f"{name}: error of BPT / of SkelBPT", **{which: gain_at(cells["SkelBPT"]["at"][-1])})
    run.note(STAND_IN)


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


def by_node_maps(integrator):
    """11.6: node maps in place of shadow rays."""
    return {**integrator, "connections": {**integrator["connections"], "node_visibility": "node_maps"}}


SEEN_BY = {which: {"rays": METHODS[which]["SkelBPT"], "node maps": by_node_maps(METHODS[which]["SkelBPT"])}
           for which in KINDS}
SEEN_IN = {"Door": SCENES["door"], "Sponza": SCENES["sponza"]}


FEW_SAVED = ("the distributions are 4 % of an iteration, so that little time is saved; on door 2 % of the decisions by maps differ as "
             "published")


def node_visibility_sweep(full, which="published"):
    return resampling_sweep(full, SEEN_BY[which], SEEN_IN.values(), seeds=5 if full else 3, which=which)


@ENTRIES.measured(
    "noel-node-visibility", "Noel 2015, 11.6, p. 169, which measures nothing",
    "a shadow map for each node instead of shadow rays makes the distributions of SkelBPT in less time",
    "bdpt with connections: skeleton, node_visibility: node_maps",
    tuple(claim(f"{name}: {text}", *figure) for name in SEEN_IN for claim, text, figure in (
        (at_least, "time of distributions by rays / by node maps", (1,)),
        (beside, "share of decisions by maps that differ", ()),
        (at_least, "error by rays / by node maps, at equal time", (1, "", FEW_SAVED)))),
    sweep=node_visibility_sweep)
def node_visibility(run):
    """SkelBPT with what nodes see decided by shadow rays and by node maps."""
    for which in KINDS:
        answers = run.answers(node_visibility_sweep(run.full, which))
        for name, scene in SEEN_IN.items():
            cells = {by: cell_with(answers, scene=scene["/scene"], integrator=value) for by, value in SEEN_BY[which].items()}
            reports = {by: [run.report(c, seed) for seed in range(answers["seeds"])] for by, c in cells.items()}
            times = {by: [r["integrator"]["distributions_cpu_seconds"] / r["counts"]["iterations"] for r in each]
                     for by, each in reports.items()}
            run.found(f"{name}: time of distributions by rays / by node maps",
                      **{which: geometric_mean_of([a / b for a, b in zip(times["rays"], times["node maps"])])})
            run.found(f"{name}: share of decisions by maps that differ", **{which: mean_of(
                [r["integrator"]["map_decisions_wrong"] / r["integrator"]["map_decisions_checked"]
                 for r in reports["node maps"]])})
            run.found(f"{name}: error by rays / by node maps, at equal time",
                      **{which: gain_at(cells["node maps"]["at"][-1])})
            shares = {by: mean_of([share_of_distributions(r["integrator"]) for r in each]) for by, each in reports.items()}
            run.tables.append(Table((f"{name}, {which}", "distributions, CPU ms an iteration", "of an iteration", "MAE"), [
                (by, f"{1000 * mean_of(times[by]).value:.3g}", f"{shares[by].value:.1%}",
                 str(error_at(cells[by]["at"][-1]))) for by in cells]))
            for built in (a for r in reports["node maps"] for a in r["artefacts"]["built"] if a["name"] == "node_maps"):
                run.note(f"{name}, {which}: the maps of all nodes took {built['seconds']:.3g} s once, before rendering, and "
                         f"{built['disk_bytes'] / 1e6:.3g} MB on disk")
    run.note("equal time is that of rendering; the maps are part of what is prepared once for a scene. A decision in 64 is "
             f"checked by a shadow ray; MAE after {answers['cells'][0]['at'][-1]['seconds']:.3g} CPU seconds, "
             f"{answers['seeds']} runs each")


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
        at_least("error of SkelBPT / of ICBPT, at equal iterations", 1), beside("time of ICBPT / of BPT", 2)),
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


@ENTRIES.measured(
    "noel-fig-106", "Noel 2015, Fig. 106, p. 179",
    "door after two hours: each distribution's own share; added up, no border of the node map shows", RESAMPLING)
def fig_106(run):
    """What each distribution of resampled connections gives to the picture of door."""
    job = {"scene": "door/scene.glb", "camera": "corner", "resolution": [1024, 512] if run.full else [256, 128],
           "budget": {"cpu_seconds": 7200 if run.full else 30}, "layers": ["distributions"]}
    rows = []
    for which in KINDS:
        for name in ("SkelBPT", "ICBPT"):
            run.render(f"{name}-{which}", {**job, "analysis": {"node_radius": RADII[which]}, "integrator": METHODS[which][name]})
            folder = run.place(f"{name}-{which}")
            run.show(f"{name}, {which}", folder)

            def mean(layer, folder=folder):
                return sum(map(sum, layers.channels(folder, layer)))

            whole = mean("")
            rows += [(name, which, layer.split(".")[1], f"{mean(layer) / whole:.1%}") for layer in layers.names(folder)
                     if layer.startswith("distributions.")]
    run.tables.append(Table(("method", "settings", "distribution", "of the picture's light"), rows))
    run.note("fallback: of eye vertices whose node was not accepted. The layer of a distribution has the vertices to which it "
             "gives the highest probability; by the max heuristic (published) no other distribution draws them")
