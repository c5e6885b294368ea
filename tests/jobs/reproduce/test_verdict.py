"""The rule by which a claim is borne out, and intervals of medians."""

import math
import random
import unittest

from harness.measured import (CONFIDENCE, Measured, error_at, exact, gain_at, geometric_mean_of, mean_of, median_of,
                              speed_up_to, time_to)
from harness.verdict import Claim, at_least, at_most, beside, near, up_to, verdict


class Verdicts(unittest.TestCase):
    def test_the_interval_decides(self):
        speed_up, seconds, bias = at_least("speed-up", 1.57), at_most("time", 0.17, "s"), up_to("bias", 0, 0.01)
        share = Claim("share", 0.5, low=0.4, high=0.6)
        for claim, low, high, expected in (
                (speed_up, 1.6, 2.0, "reached"), (speed_up, 1.57, 2.0, "reached"), (speed_up, 1.2, 1.56, "missed"),
                (speed_up, 1.5, 1.6, "not told apart"), (seconds, 0.1, 0.17, "reached"), (seconds, 0.2, 0.3, "missed"),
                (seconds, 0.1, 0.2, "not told apart"), (bias, -0.4, 0.009, "reached"), (bias, 0.011, 0.2, "missed"),
                (bias, -0.4, 0.02, "not told apart"), (share, 0.1, 0.9, "not told apart"),
                (share, 0.45, 0.55, "reached")):
            with self.subTest(claim=str(claim), low=low, high=high):
                self.assertEqual(verdict(claim, Measured((low + high) / 2, low, high, 3)), expected)

    def test_without_an_interval_nothing_is_told_apart(self):
        claim = at_least("speed-up", 1.57)
        self.assertEqual(verdict(claim, Measured(100)), "one run")
        self.assertEqual(verdict(claim, Measured(100, n=3)), "not told apart")
        self.assertEqual(verdict(claim, Measured(100, bound="at least")), "not told apart")
        self.assertEqual(verdict(claim, Measured(100, 90, 110, 3, supported=False)), "not told apart")
        self.assertEqual(verdict(claim, None), "not measured")
        self.assertEqual(verdict(beside("seconds", 3677.44, "s"), Measured(100, 90, 110, 3)), "")
        self.assertEqual(verdict(claim, exact(2)), "reached")
        for value, expected in ((3.1, "missed"), (3.3, "reached"), (4.9, "reached"), (5.1, "missed")):
            self.assertEqual(verdict(near("ratio", 4), exact(value)), expected)

    def test_figures_are_told_with_their_direction(self):
        self.assertEqual([str(c) for c in (at_least("a", 1.57), at_most("a", 0.17, "s"), up_to("a", 0, 0.01),
                                           near("a", 4), beside("a", 3677.44, "s"), beside("a"))],
                         [">= 1.57", "<= 0.17 s", "0, up to 0.01", "4, 3.2 to 5", "3677.44 s", ""])


class Medians(unittest.TestCase):
    def test_six_values_are_the_fewest_with_an_interval(self):
        self.assertIsNone(median_of([5, 3, 1, 4, 2]).low)
        self.assertEqual(median_of([5, 3, 1, 6, 4, 2]), Measured(3.5, 1, 6, 6))
        self.assertEqual(median_of(range(1, 21)), Measured(10.5, 6, 15, 20))  # of tables of the sign test

    def test_ratios_have_intervals_that_reach_as_far_as_both(self):
        r = Measured(4, 2, 8, 6).ratio(Measured(2, 1, 4, 3))
        self.assertAlmostEqual(r.low, 2 / 2**math.sqrt(2))
        self.assertAlmostEqual(r.high, 2 * 2**math.sqrt(2))
        self.assertEqual((r.value, r.n), (2, 3))
        self.assertIsNone(Measured(4, 2, 8).ratio(Measured(2)).low)
        self.assertIsNone(Measured(4, -1, 8).ratio(Measured(2, 1, 4)).low)
        self.assertFalse(Measured(4, 2, 8).ratio(Measured(2, 1, 4, supported=False)).supported)

    def test_the_interval_holds_the_median_as_often_as_it_says(self):
        rng, trials = random.Random(1), 4000
        for n, probability in ((6, 1 - 2 / 2**6), (20, 1 - 2 * sum(math.comb(20, i) for i in range(6)) / 2**20)):
            self.assertGreaterEqual(probability, CONFIDENCE)
            held = 0
            for _ in range(trials):
                m = median_of([rng.lognormvariate(0, 1) for _ in range(n)])  # its median is 1
                held += m.low <= 1 <= m.high
            deviation = math.sqrt(trials * probability * (1 - probability))
            self.assertLess(abs(held - trials * probability), 4 * deviation)


    def test_means_hold_the_truth_as_often_as_they_say(self):
        rng, trials = random.Random(2), 4000
        for n in (2, 3, 6, 40):
            held = [0, 0]
            for _ in range(trials):
                values = [rng.gauss(3, 1) for _ in range(n)]
                for i, (m, truth) in enumerate(((mean_of(values), 3),
                                                (geometric_mean_of([math.exp(v) for v in values]), math.exp(3)))):
                    self.assertEqual(m.n, n)
                    held[i] += m.low <= truth <= m.high
            deviation = math.sqrt(trials * CONFIDENCE * (1 - CONFIDENCE))
            for times in held:  # beyond the table the interval is wider than need be
                self.assertGreater(times - trials * CONFIDENCE, -4 * deviation)
                self.assertLess(times - trials * CONFIDENCE, 4 * deviation + (60 if n > 21 else 0))
        self.assertEqual(mean_of([4.0]), Measured(4.0))

    def test_ratios_of_bounds_are_bounds_or_nothing(self):
        number, least, most = Measured(4, 2, 8), Measured(4, bound="at least"), Measured(2, bound="at most")
        self.assertEqual(least.ratio(number).bound, "at least")
        self.assertEqual(number.ratio(most).bound, "at least")
        self.assertEqual(number.ratio(least).bound, "at most")
        self.assertEqual(least.ratio(most).bound, "at least")
        self.assertIsNone(least.ratio(least))


class Answers(unittest.TestCase):
    estimate = {"value": 2.0, "low": 1.5, "high": 2.5, "n": 3}

    def test_estimates_keep_their_intervals(self):
        at = {"error": self.estimate, "gain": None, "supported": False}
        self.assertEqual(error_at(at), Measured(2.0, 1.5, 2.5, 3, supported=False))
        self.assertIsNone(gain_at(at))

    def test_bounds_are_no_estimates(self):
        to = {"time": self.estimate, "at_most": False, "at_least": None, "supported": True,
              "speed_up": {"value": 4.0, "n": 3, "at_least": True}}
        self.assertEqual(time_to(to), Measured(2.0, 1.5, 2.5, 3))
        self.assertEqual(speed_up_to(to), Measured(4.0, n=3, bound="at least"))
        self.assertEqual(time_to({**to, "at_most": True}), Measured(2.0, n=3, bound="at most"))
        self.assertEqual(time_to({**to, "time": None, "at_least": 8.0}), Measured(8.0, bound="at least"))
