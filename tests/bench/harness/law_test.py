#!/usr/bin/env python3
"""That the fit finds the law by which figures were made, and sees a square where there is one and nowhere else."""

import random
import unittest

from law import Law

OTHERS = [1, 4, 9, 19, 39]


def points(law, noise=0.0):
    chance = random.Random(1)
    return [(x, law(x) * (1 + chance.gauss(0, noise))) for x in OTHERS]


class LawTest(unittest.TestCase):
    def test_finds_what_is_fixed_and_what_each_other_adds(self):
        law = Law(points(lambda x: 2 + 3 * x))
        self.assertAlmostEqual(law.fixed, 2)
        self.assertAlmostEqual(law.each, 3)
        self.assertAlmostEqual(law.furthest, 0)

    def test_wants_no_square_for_noise(self):
        self.assertIs(Law(points(lambda x: 2 + 3 * x, 0.05)).wants_square, False)

    def test_wants_a_square_that_stands_out_of_the_noise(self):
        law = Law(points(lambda x: 2 + 3 * x + 0.2 * x * x, 0.05))
        self.assertIs(law.wants_square, True)
        self.assertAlmostEqual(law.square_share, 0.2 * 39 * 39 / (2 + 3 * 39 + 0.2 * 39 * 39), delta=0.1)

    def test_wants_no_square_for_what_grows_ever_more_slowly(self):
        self.assertIs(Law(points(lambda x: 10 * x ** 0.5, 0.01)).wants_square, False)

    def test_judges_no_square_by_three_points(self):
        self.assertIsNone(Law(points(lambda x: 2 + 3 * x)[:3]).wants_square)


if __name__ == "__main__":
    unittest.main()
