"""Numbers of ours, each with its interval."""

import dataclasses
import math
import statistics

CONFIDENCE = 0.95  # that of jobs/statistics/estimate.h; Run.answers() compares them


@dataclasses.dataclass(frozen=True)
class Measured:
    """A number with the interval that holds the truth with probability CONFIDENCE, from `n` independent runs; without
    `low` and `high` there is none. `bound`: the number is only an "at least" or an "at most". `supported` is false
    where the reference's own noise is too large for it."""

    value: float
    low: float | None = None
    high: float | None = None
    n: int = 1
    bound: str = ""
    supported: bool = True

    def scaled(self, factor):
        """Times a positive number."""
        bounds = {} if self.low is None else {"low": self.low * factor, "high": self.high * factor}
        return dataclasses.replace(self, value=self.value * factor, **bounds)

    def ratio(self, other):
        """Over an independent positive number: relative half widths add up as squares do. Without both intervals, or
        where one reaches 0, there is none."""
        value = self.value / other.value
        if None in (self.low, other.low) or min(self.low, other.low) <= 0:
            return Measured(value, n=min(self.n, other.n), supported=self.supported and other.supported)
        spread = math.exp(math.hypot(*(math.log(m.high / m.low) / 2 for m in (self, other))))
        return Measured(value, value / spread, value * spread, min(self.n, other.n),
                        supported=self.supported and other.supported)

    def __str__(self):
        text = {"": "", "at least": ">= ", "at most": "<= "}[self.bound] + f"{self.value:.3g}"
        if self.low is not None and self.low < self.high:
            text += f" [{self.low:.3g}, {self.high:.3g}]"
        return text if self.supported else f"({text})"


def exact(value):
    """What no chance is in, as a count."""
    return Measured(value, value, value)


def median_of(values):
    """The median, with the interval that the sign test gives: the k-th smallest and the k-th largest of n values of any
    continuous distribution hold its median with probability 1 - 2 P(Binomial(n, 1/2) < k). Six values are the fewest
    that have one at 95 %. For times, whose disturbances all go one way."""
    ordered, n = sorted(values), len(values)
    k, tail = 0, 1 / 2**n
    while tail <= (1 - CONFIDENCE) / 2:
        k += 1
        tail += math.comb(n, k) / 2**n
    bounds = {"low": ordered[k - 1], "high": ordered[n - k]} if k > 0 else {}
    return Measured(statistics.median(ordered), n=n, **bounds)


def of_answer(estimate, supported=True):
    """An estimate or a gain of `lacuna report --json`; None where there is none."""
    if estimate is None:
        return None
    return Measured(estimate["value"], estimate.get("low"), estimate.get("high"), estimate["n"],
                    "at least" if estimate.get("at_least") else "", supported)


def error_at(at):
    """The error of a member of `at` of a cell."""
    return of_answer(at["error"], at["supported"])


def gain_at(at):
    """The baseline's error over the cell's own, at equal time."""
    return of_answer(at["gain"], at["supported"])


def time_to(to):
    """The seconds of a member of `to` of a cell; a bound where not all runs reached the error, or some at once."""
    if to["time"] is None:
        shortest = to["at_least"]
        return None if shortest is None else Measured(shortest, bound="at least", supported=to["supported"])
    time = of_answer(to["time"], to["supported"])
    return dataclasses.replace(time, low=None, high=None, bound="at most") if to["at_most"] else time


def speed_up_to(to):
    """The baseline's time over the cell's own, to equal error."""
    return of_answer(to["speed_up"], to["supported"])
