"""Resampled connections on all scenes of chapter 11: Table 6, and the figures of scenes for which others stand."""

from harness.entry import Entries
from harness.measured import error_at, gain_at, speed_up_to, time_to
from harness.run import KINDS, Table, cell_with
from harness.verdict import at_least, near, up_to
from noel_connections import (BPT, COUNTS, ICBPT, METHODS, RESAMPLED, RESAMPLING, all_methods, resampled, resampled_cell,
                              resampled_table, resampling_sweep, show_pictures)

ENTRIES = Entries()
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


def find_speed_ups(run, which, name, to):
    """The rows of Table 6 of a scene. `to`: of each method its member of `to`."""
    for method in ("ICBPT", "SkelBPT"):
        run.found(f"{name}, {method}: speed-up", **{which: speed_up_to(to[method])})


# To which error, and the speed-ups over BPT of ICBPT and of SkelBPT; the thesis' seconds are these times 3677 s, 1910 s and 1334 s.
TABLE_6 = {"Door": (0.01, 0.51, 1.57), "Sponza": (0.15, 0.40, 2.82), "Sibenik": (0.025, 0.42, 1.02)}
RECORDS = ("an iteration takes 2.0 times that of BPT at the quick 256 x 128 pixels, where records are few, and 2.7 times at 1024 x 512; the "
           "author's own code 2.9 times on door and 4.9 on corridor. Error after as many iterations is 1.6 times lower here on sponza; "
           "why the author's gained less is not known")


@ENTRIES.measured(
    "noel-table-6", "Noel 2015, Table 6, p. 169", "time to equal L1 error, and speed-up over BPT", RESAMPLING,
    (*(claim for name, (_, cached, skeleton) in TABLE_6.items() for claim in (
        up_to(f"{name}, ICBPT: speed-up", cached, 1, why=RECORDS),
        at_least(f"{name}, SkelBPT: speed-up", skeleton, why=COUNTS))),
     at_least("Door, SkelBPT over uniform: speed-up", 1), at_least("Sponza, SkelBPT over uniform: speed-up", 1)))
def table_6(run):
    """Time to equal L1 error of bidirectional path tracing with paired connections (BPT), importance caching (ICBPT) and
    the skeleton (SkelBPT); and the skeleton's gain alone, over resampling without any guidance with all else equal."""
    for which in KINDS:
        answers = all_methods(run, which)
        for name in ("Door", "Sponza"):
            to = {method: resampled_cell(answers, name.lower(), value)["to"][-1] for method, value in METHODS[which].items()}
            find_speed_ups(run, which, name, to)
            plain, guided = time_to(to["uniform"]), time_to(to["SkelBPT"])
            run.found(f"{name}, SkelBPT over uniform: speed-up", **{which: plain and guided and plain.ratio(guided)})
        run.tables += [resampled_table(answers, scene, METHODS[which], f", {which}") for scene in RESAMPLED]
        stand_in = {method: cell["to"][-1] for method, cell in on_stand_in(run, which, "Sibenik").items()}
        find_speed_ups(run, which, "Sibenik", stand_in)
    run.note(f"Sibenik: {STAND_INS['Sibenik']['/scene']}, {STAND_IN}")
    run.note("CPU seconds of a core; equal error: the lowest MAE that every run of a scene reached; "
             f"{answers['seeds']} runs each")


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


@ENTRIES.measured(*resampled(100, 173, "sibenik (similar to BPT)", 300, ICBPT, near(BPT.quantity, 1)),
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
