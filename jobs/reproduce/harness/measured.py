"""Numbers of ours, each with its interval."""

import dataclasses
import math
import statistics

CONFIDENCE = 0.95  # that of jobs/sweep/estimate.h; Run.answers() compares them


@dataclasses.dataclass(frozen=True)
class Measured:
    """A number with the interval that holds the truth with probability CONFIDENCE, from `n` independent runs; without
    `low` and `high` there is none: Measured(x) is that of one run. `bound`: the number is only an "at least" or an
    "at most". `supported` is false where the reference's own noise is too large for it."""

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

    def root(self):
        """Its square root; of a positive number."""
        bounds = {} if self.low is None else {"low": math.sqrt(self.low), "high": math.sqrt(self.high)}
        return dataclasses.replace(self, value=math.sqrt(self.value), **bounds)

    def ratio(self, other):
        """Over an independent positive number: relative half widths add up as squares do. Without both intervals, or
        where one reaches 0, there is none. None where a bound is divided by one that says nothing of the ratio."""
        value = self.value / other.value
        if self.bound or other.bound:
            bound = self._bound_over(other)
            return bound and Measured(value, n=min(self.n, other.n), bound=bound,
                                      supported=self.supported and other.supported)
        if None in (self.low, other.low) or min(self.low, other.low) <= 0:
            return Measured(value, n=min(self.n, other.n), supported=self.supported and other.supported)
        spread = math.exp(math.hypot(*(math.log(m.high / m.low) / 2 for m in (self, other))))
        return Measured(value, value / spread, value * spread, min(self.n, other.n),
                        supported=self.supported and other.supported)

    def _bound_over(self, other):
        """"at least" over a number is at least that much, and so is a number over "at most"; None where two bounds pull
        apart."""
        turned = {"": "", "at least": "at most", "at most": "at least"}[other.bound]
        bounds = {self.bound, turned} - {""}
        return bounds.pop() if len(bounds) == 1 else None

    def __str__(self):
        text = {"": "", "at least": ">= ", "at most": "<= "}[self.bound] + f"{self.value:.3g}"
        if self.low is not None and self.low < self.high:
            text += f" [{self.low:.3g}, {self.high:.3g}]"
        return text if self.supported else f"({text})"


def exact(value):
    """What no chance is in: the same from any seed, as a count of nodes. A single random number is Measured(value)."""
    return Measured(value, value, value)


# Of Student's distribution: the half width of a two-sided interval at CONFIDENCE, in standard errors, for 1, 2, ... degrees
# of freedom; beyond the last, that of the last.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
           2.110, 2.101, 2.093, 2.086)


def mean_of(values):
    """The mean of independent numbers that are spread about normally, with Student's interval; one value has none."""
    n = len(values)
    mean = statistics.fmean(values)
    if n < 2:
        return Measured(mean)
    half = STUDENT[min(n - 1, len(STUDENT)) - 1] * statistics.stdev(values) / math.sqrt(n)
    return Measured(mean, mean - half, mean + half, n)


def geometric_mean_of(values):
    """The same of the logarithms of positive numbers, as of ratios of errors of runs with the same seed."""
    m = mean_of([math.log(v) for v in values])
    bounds = {} if m.low is None else {"low": math.exp(m.low), "high": math.exp(m.high)}
    return Measured(math.exp(m.value), n=m.n, **bounds)


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
