"""What a paper claims of a quantity, and whether a measurement bears it out."""

import dataclasses
import math

REACHED, MISSED, NOT_TOLD_APART = "reached", "missed", "not told apart"
NOT_MEASURED, ONE_RUN = "not measured", "one run"


@dataclasses.dataclass(frozen=True)
class Claim:
    """The paper's `figure` of a quantity, and which values of ours bear it out: those in [low, high]. Without bounds
    a quantity of ours stands there as information. `figure` may be absent, `unit` empty (a ratio or a count). `why`: the
    reason found where it is missed."""

    quantity: str
    figure: float | None
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    why: str = ""

    @property
    def judged(self):
        return math.isfinite(self.low) or math.isfinite(self.high)

    def __str__(self):
        """The figure, as ">= 1.57", "<= 0.17 s", "0, up to 0.01" or "4, 3.2 to 5"; empty without one."""
        if self.figure is None:
            return ""
        relation = {self.low: ">= ", self.high: "<= "}.get(self.figure, "")
        text = f"{relation}{self.figure:.6g}{self.unit and ' ' + self.unit}"
        if relation or not self.judged:
            return text
        return f"{text}, up to {self.high:.6g}" if self.low == -math.inf else f"{text}, {self.low:.3g} to {self.high:.3g}"


def at_least(quantity, figure, unit="", why=""):
    return Claim(quantity, figure, unit, low=figure, why=why)


def at_most(quantity, figure, unit="", why=""):
    return Claim(quantity, figure, unit, high=figure, why=why)


def up_to(quantity, figure, high, unit="", why=""):
    """A figure that ours need not meet exactly: it may be as much as `high`."""
    return Claim(quantity, figure, unit, high=high, why=why)


NEAR = 1.25  # by convention: what another machine, grid or camera may change of a ratio or of a count


def near(quantity, figure, unit="", why=""):
    """A figure that is told without a direction: ours may be up to NEAR times larger or smaller."""
    return Claim(quantity, figure, unit, figure / NEAR, figure * NEAR, why)


def beside(quantity, figure=None, unit=""):
    return Claim(quantity, figure, unit)


def verdict(claim, ours):
    """`reached` if our whole interval lies in what the claim allows, `missed` if all of it lies outside, and
    `not told apart` if it holds a border of the two: more runs would tell.

    A number of one run has no interval, and the verdict is `one run`. Also not told apart is a bound such as "at least 3
    times, when time was up", and what the reference is too noisy for. `not measured` without a measurement; empty where
    nothing is claimed."""
    if not claim.judged:
        return ""
    if ours is None:
        return NOT_MEASURED
    if ours.low is None and ours.n == 1 and not ours.bound:
        return ONE_RUN
    if ours.low is None or not ours.supported:
        return NOT_TOLD_APART
    if claim.low <= ours.low and ours.high <= claim.high:
        return REACHED
    if ours.high < claim.low or claim.high < ours.low:
        return MISSED
    return NOT_TOLD_APART
