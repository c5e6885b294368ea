"""Probabilistic connections of bidirectional path tracing, which Noel's thesis (11.6) planned to compare with and did not,
beside importance caching and the skeleton. The paper's text was not at hand (docs/methods/connections-records.md): what is
judged is what its abstract and its first figure claim, on this project's scenes."""

from harness.entry import Entries
from harness.measured import error_at, gain_at
from harness.run import AS, KINDS
from harness.verdict import at_least, beside
from noel_connections import (DEPTH, OURS, SCENES, THESIS, bdpt, resampled_cell, resampled_table, resampling_sweep)

ENTRIES = Entries()
PCBPT = {"published": bdpt({"type": "probabilistic", "light_paths": 1024, "draws": 1, "neighbours": 1}, roulette_depth=DEPTH,
                           **AS["published"]),
         "ours": bdpt({"type": "probabilistic"})}
METHODS = {"published": {**THESIS, "PCBPT": PCBPT["published"]}, "ours": {**OURS, "PCBPT": PCBPT["ours"]}}
COMPARED = ("door", "sponza")
ONE_DRAW = ("an eye vertex makes one connection in all, that of the others one for each length, and yet an iteration takes longer: 22 "
            "in 3 CPU seconds on door as published, SkelBPT's 30; distributions take a third of it. On corridor it leads BPT with this "
            "project's settings, on door at 512 x 256 pixels they are not told apart "
            "(docs/methods/connections-records.md)")


def popov_sweep(full, which="published"):
    return resampling_sweep(full, METHODS[which], [SCENES[s] for s in COMPARED], seeds=5 if full else 3, which=which)


@ENTRIES.measured(
    "popov-connections", "Popov et al. 2015, abstract and Fig. 1",
    "error at equal time of BPT and of importance caching against probabilistic connections",
    "bdpt with connections: probabilistic", tuple(claim for s in COMPARED for claim in (
        at_least(f"{s}: error of BPT / of PCBPT", 1, why=ONE_DRAW), at_least(f"{s}: error of ICBPT / of PCBPT", 1, why=ONE_DRAW),
        beside(f"{s}: error of SkelBPT / of PCBPT"))),
    sweep=popov_sweep)
def connections(run):
    """Every connection strategy at equal time, at the settings of the papers and at this project's."""
    for which in KINDS:
        answers = run.answers(popov_sweep(run.full, which))
        for scene in COMPARED:
            at = {name: resampled_cell(answers, scene, value)["at"][-1] for name, value in METHODS[which].items()}
            best = error_at(at["PCBPT"])
            run.found(f"{scene}: error of BPT / of PCBPT", **{which: gain_at(at["PCBPT"])})
            for name in ("ICBPT", "SkelBPT"):
                other = error_at(at[name])
                run.found(f"{scene}: error of {name} / of PCBPT", **{which: other and best and other.ratio(best)})
            run.tables.append(resampled_table(answers, scene, METHODS[which], f", {which}"))
        run.note(f"{which}: MAE after {at['BPT']['seconds']:.3g} CPU seconds, {answers['seeds']} runs each")
    run.note("published: one draw by the nearest record, counted as one sample (the bound of the paper for samples that share "
             "light paths, as Grittmann et al. 2021 have it), all light paths splatted, no roulette. The number of light "
             "paths and the density of records are this project's: the paper's were not at hand")
    run.note("the paper's own scenes are not to be had, and 8 minutes of its machine are not 3 CPU seconds of a small "
             "picture: the quick form tells the order of the methods, the full one their ratios")
