"""The step of variance across borders of regions, on pictures whose step is known."""

import math
import unittest

from noel_regions import Borders, past_the_door

WIDTH, HEIGHT, MIDDLE = 40, 36, 20
RED, BLUE, NONE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)


def picture(of):
    """of(x, y) for every pixel."""
    return [of(x, y) for y in range(HEIGHT) for x in range(WIDTH)]


def borders(label, surface=lambda p, q: True):
    return Borders(picture(label), surface, WIDTH, HEIGHT, 2)


def halves(x, _):
    return RED if x < MIDDLE else BLUE


def slope(factor):
    """Variances that grow by a tenth with each pixel to the right, and by `factor` in the middle."""
    return picture(lambda x, _: math.exp(0.1 * x) * (factor if x >= MIDDLE else 1))


class Steps(unittest.TestCase):
    def test_a_step_is_measured_against_the_slope_beside_it(self):
        for factor in (1, 2, 4):
            ratio, count = borders(halves).step(slope(factor))
            self.assertAlmostEqual(ratio, (0.2 + math.log(factor)) / 0.2)
            self.assertEqual(count, 1)

    def test_borders_along_rows_count_too(self):
        along = borders(lambda x, y: RED if y < MIDDLE else BLUE)
        ratio, count = along.step(picture(lambda _, y: math.exp(0.1 * y) * (3 if y >= MIDDLE else 1)))
        self.assertAlmostEqual(ratio, (0.2 + math.log(3)) / 0.2)
        self.assertEqual(count, 1)

    def test_edges_of_surfaces_and_pixels_without_a_region_are_no_borders(self):
        def edge(p, q):
            return (p % WIDTH < MIDDLE) == (q % WIDTH < MIDDLE)
        for found in (borders(halves, edge), borders(lambda x, _: RED if x < MIDDLE else NONE)):
            self.assertEqual(found.strips, {})
            with self.assertRaises(ValueError):
                found.step(slope(1))

    def test_short_borders_say_nothing(self):
        with self.assertRaises(ValueError):
            borders(halves).step(slope(1), least=2 * HEIGHT + 1)
        self.assertEqual(borders(halves).step(slope(1), least=2 * HEIGHT)[1], 1)


class Rays(unittest.TestCase):
    def test_the_side_of_the_door_that_the_back_room_sees_is_not_the_main_room(self):
        self.assertTrue(past_the_door({"at": [0, 50, 100]}))
        self.assertTrue(past_the_door({"at": [170, 50, -60]}))
        self.assertFalse(past_the_door({"at": [90, 50, -65]}))
        self.assertFalse(past_the_door({"at": [170, 50, -100]}))
        self.assertFalse(past_the_door({"at": None}))
