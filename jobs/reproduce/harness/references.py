"""Noel 2015, chapter 4: the integrators that the methods are compared with; and ours against renders of others."""

from harness.entry import Entry
from harness.verdict import at_least, beside, up_to

# A picture counts as unbiased within a tenth of its mean radiance; here squared.
UNBIASED = 0.1**2

ENTRIES = (
    Entry("path-corridor", "the thesis author's own render, 63,555 samples a pixel (corridor/reference.exr)",
          "path tracing without and with next event estimation: error at equal time, time to equal error, bias",
          "path",
          (beside("relMSE at equal time, without"), beside("relMSE at equal time, with"),
           at_least("error without / with, at equal time", 1), beside("CPU seconds to equal relMSE, without"),
           beside("CPU seconds to equal relMSE, with"), at_least("time without / with, to equal relMSE", 1),
           up_to("squared bias / squared mean radiance, without", 0, UNBIASED),
           up_to("squared bias / squared mean radiance, with", 0, UNBIASED))),
    Entry("noel-fig-20", "Noel 2015, Fig. 20, p. 48",
          "less noise with bidirectional path tracing than with path tracing after 90 s", "bdpt",
          (at_least("error of path tracing / of bidirectional, at equal time", 1),)),
    Entry("noel-fig-23", "Noel 2015, Fig. 23, p. 52",
          "instant global illumination has structured errors where bidirectional path tracing has noise, after 90 s",
          "bdpt; many_lights with visibility: exact"),
    Entry("noel-fig-25", "Noel 2015, Fig. 25, p. 58",
          "photon mapping stays blurred, progressive photon mapping converges to the picture", "photon_map; sppm"),
)
