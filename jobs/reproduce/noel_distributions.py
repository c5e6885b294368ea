"""The distributions of resampled connections: how many there are, what nodes see, and what each gives to the picture."""

from harness import layers
from harness.entry import Entries
from harness.measured import Measured, error_at, exact, gain_at, geometric_mean_of, mean_of
from harness.run import AS, KINDS, Table, cell_with
from harness.verdict import at_least, beside, near
from noel_connections import METHODS, OURS, RESAMPLING, SCENES, resampling_sweep
from noel_regions import Borders, one_surface
from noel_shadows import CHESSBOARD, GRID, NODES
from noel_stand_ins import STAND_IN, STAND_INS

ENTRIES = Entries()
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
    value["axes"]["/analysis/node_radius"] = list(NODES.values())
    value["zip"] = [{pointer: [s[pointer] for s in scenes] for pointer in ("/scene", "/camera", "/resolution")}]
    value["job"]["budget"] = {"iterations": 16 if full else 4}
    return value


TABLE_5 = {"Door": (74, 9), "Sponza": (666, 45), "Sibenik": (1420, 85)}  # nodes, and those of an iteration
WHY = {"Door": CHESSBOARD, "Sponza": CHESSBOARD,
         "Sibenik": "another scene: a nave with two rows of pillars, which has fewer passages than the church"}


@ENTRIES.measured(
    "noel-table-5", "Noel 2015, Table 5, p. 167", "nodes of the filtered skeleton, and nodes used per iteration",
    "bdpt with connections: skeleton",
    tuple(near(f"{name}, {what}", count, why=WHY.get(name, "")) for name, counts in TABLE_5.items()
          for what, count in zip(("nodes", "per iteration"), counts)),
    sweep=table_5_sweep)
def table_5(run):
    """Nodes of the filtered skeleton, and how many of them have distributions in an iteration."""
    answers = run.answers(table_5_sweep(run.full))
    for name, scene in (("Door", SCENES["door"]), ("Sponza", SCENES["sponza"]), ("Sibenik", STAND_INS["Sibenik"])):
        for which, radius in NODES.items():
            told = run.report(cell_with(answers, scene=scene["/scene"], node_radius=radius))["integrator"]
            run.found(f"{name}, nodes", **{which: exact(told["nodes"])})
            run.found(f"{name}, per iteration", **{which: Measured(told["nodes_used"])})
        run.note(f"{name}: the distributions take {share_of_distributions(told):.1%} of an iteration")
    run.note(f"{GRID['resolution']} voxels along the longest side, as in Table 1: the thesis does not tell those of Table 5")
    run.note(f"Sibenik: {STAND_INS['Sibenik']['/scene']}, {STAND_IN}")


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


SEAM = "step across borders of the node map, largest distribution alone / all together"


@ENTRIES.measured(
    "noel-fig-106", "Noel 2015, Fig. 106, p. 179",
    "door after two hours: each distribution's own share; added up, no border of the node map shows", f"{RESAMPLING}; inspect",
    (at_least(SEAM, 1),))
def fig_106(run):
    """What each distribution of resampled connections gives to the picture of door."""
    side = [1024, 512] if run.full else [256, 128]
    job = {"scene": "door/scene.glb", "camera": "corner", "resolution": side,
           "budget": {"cpu_seconds": 7200 if run.full else 30}, "layers": ["distributions"]}
    rows = []
    for which in KINDS:
        run.render(f"nodes-{which}", {**job, **AS[which], "budget": {"iterations": 1}, "layers": ["normal", "depth"],
                                      "integrator": {"type": "inspect", "show": "filtered_mapping"}})
        nodes = run.place(f"nodes-{which}")
        borders = Borders(list(zip(*layers.channels(nodes, ""))), one_surface(nodes), *side, max(2, side[0] // 128))
        for name in ("SkelBPT", "ICBPT"):
            run.render(f"{name}-{which}", {**job, **AS[which], "integrator": METHODS[which][name]})
            folder = run.place(f"{name}-{which}")
            run.show(f"{name}, {which}", folder)
            light = {layer: [sum(p) for p in zip(*layers.channels(folder, layer))]
                     for layer in ("", *layers.names(folder)) if layer == "" or layer.startswith("distributions.")}
            sums = {layer: sum(values) for layer, values in light.items()}
            rows += [(name, which, layer.split(".")[1], f"{s / sums['']:.1%}") for layer, s in sums.items() if layer]
            if name == "SkelBPT":
                most = max((layer for layer in sums if layer), key=sums.get)
                run.found(SEAM, **{which: Measured(borders.step(light[most])[0] / borders.step(light[""])[0])})
    run.tables.append(Table(("method", "settings", "distribution", "of the picture's light"), rows))
    run.note("fallback: of eye vertices whose node was not accepted. The layer of a distribution has the vertices to which it "
             "gives the highest probability; by the max heuristic (published) no other distribution draws them")
