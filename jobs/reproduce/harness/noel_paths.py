"""Noel 2015, chapters 9, 10.4 and 11: guided rays and resampled connections."""

from harness.entry import Entry
from harness.verdict import at_least, at_most, beside

SKELETON_GUIDE = "path with guide: skeleton"
RESAMPLING = "bdpt with connections: skeleton, importance_cache"
GAIN = "error of BSDF sampling / of ours, at equal time"


def guided(number, page, configuration, minutes, *more):
    return Entry(f"noel-fig-{number}", f"Noel 2015, Fig. {number}, p. {page}",
                 f"{configuration}: lower error than BSDF sampling after {minutes} min", SKELETON_GUIDE,
                 (at_least(GAIN, 1), *more))


def resampled(number, page, configuration, seconds, *claims):
    return Entry(f"noel-fig-{number}", f"Noel 2015, Fig. {number}, p. {page}",
                 f"{configuration}: error after {seconds} s of BPT, SkelBPT and ICBPT", RESAMPLING, claims)


BPT = at_least("error of BPT / of SkelBPT", 1)
ICBPT = at_least("error of ICBPT / of SkelBPT", 1)

ENTRIES = (
    guided(71, 132, "corridor, diffuse, s = 16", 20, beside("iterations, BSDF sampling", 10694),
           beside("iterations, s = 16", 4513), beside("iterations, s = 1", 8307)),
    guided(72, 133, "sponza plugging, s = 8", 30),
    guided(73, 134, "sponza glossy", 30),
    guided(74, 135, "plants", 60),
    guided(75, 136, "apartment", 60),
    Entry("noel-fig-76", "Noel 2015, Fig. 76, p. 137",
          "sponza dark after 15 min: a larger strength lessens noise in one part and adds it in another",
          SKELETON_GUIDE, (at_least("blue frame: error at least strength / at largest", 1),
                           at_most("red frame: error at least strength / at largest", 1))),
    Entry("noel-fig-77", "Noel 2015, Fig. 77, p. 138", "convergence: lower error in every configuration",
          SKELETON_GUIDE, tuple(at_least(f"{c}: {GAIN}", 1) for c in (
              "corridor", "sponza plugging", "sponza glossy", "plants", "apartment", "sponza dark"))),
    Entry("noel-fig-91", "Noel 2015, Fig. 91, p. 155",
          "door, rays through portals: less noise than BSDF sampling after 4096 iterations", "path with guide: portals",
          (at_least("error of BSDF sampling / of portals, at equal iterations", 1),)),
    Entry("noel-fig-94", "Noel 2015, Fig. 94, p. 158 (too bright there: section 10.4.2)",
          "door, face irradiance: less noise than BSDF sampling after 4096 iterations",
          "path with guide: face_irradiance",
          (at_least("error of BSDF sampling / of face irradiance, at equal iterations", 1),)),
    Entry("noel-table-5", "Noel 2015, Table 5, p. 167", "nodes of the filtered skeleton, and nodes used per iteration",
          "bdpt with connections: skeleton",
          (beside("Door, nodes", 74), beside("Door, per iteration", 9), beside("Sponza, nodes", 666),
           beside("Sponza, per iteration", 45), beside("Sibenik, nodes", 1420), beside("Sibenik, per iteration", 85))),
    Entry("noel-table-6", "Noel 2015, Table 6, p. 169", "time to equal L1 error, and speed-up over BPT", RESAMPLING,
          (beside("Door to 0.01, BPT", 3677.44, "s"), beside("Door, ICBPT", 7095.64, "s"),
           beside("Door, SkelBPT", 2341.36, "s"), beside("Door, ICBPT: speed-up", 0.51),
           at_least("Door, SkelBPT: speed-up", 1.57), beside("Sponza to 0.15, BPT", 1910.39, "s"),
           beside("Sponza, ICBPT", 4731.15, "s"), beside("Sponza, SkelBPT", 675.98, "s"),
           beside("Sponza, ICBPT: speed-up", 0.40), at_least("Sponza, SkelBPT: speed-up", 2.82),
           beside("Sibenik to 0.025, BPT", 1334.48, "s"), beside("Sibenik, ICBPT", 3114.65, "s"),
           beside("Sibenik, SkelBPT", 1298.69, "s"), beside("Sibenik, ICBPT: speed-up", 0.42),
           at_least("Sibenik, SkelBPT: speed-up", 1.02))),
    resampled(98, 171, "door", 300, BPT, ICBPT),
    resampled(99, 172, "sponza", 300, BPT, ICBPT),
    resampled(100, 173, "sibenik (similar to BPT)", 300, ICBPT),
    resampled(101, 174, "apartment (ICBPT beats BPT, SkelBPT both)", 900, BPT, ICBPT),
    resampled(102, 175, "plants (ICBPT and SkelBPT similar, both beat BPT)", 900, BPT),
    Entry("noel-fig-103", "Noel 2015, Fig. 103, p. 176",
          "L1 error curves of 300 s: SkelBPT below BPT on door and sponza, the same on sibenik", RESAMPLING, (
              at_least("Door: error of BPT / of SkelBPT", 1), at_least("Sponza: error of BPT / of SkelBPT", 1))),
    Entry("noel-fig-104", "Noel 2015, Fig. 104, p. 177",
          "L1 error curves of 900 s: SkelBPT below BPT on apartment and plants", RESAMPLING, (
              at_least("Apartment: error of BPT / of SkelBPT", 1), at_least("Plants: error of BPT / of SkelBPT", 1))),
    Entry("noel-fig-105", "Noel 2015, Fig. 105, p. 178",
          "after 64 iterations ICBPT has the lowest error, at about twice the time of BPT", RESAMPLING, (
              at_least("error of BPT / of ICBPT, at equal iterations", 1),
              at_least("error of SkelBPT / of ICBPT, at equal iterations", 1), beside("time of ICBPT / of BPT", 2))),
    Entry("noel-fig-106", "Noel 2015, Fig. 106, p. 179",
          "door after two hours: each distribution's own share; added up, no border of the node map shows", RESAMPLING),
)
