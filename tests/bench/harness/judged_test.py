#!/usr/bin/env python3
"""That a ratio is called worse if it is, and that noise alone is not taken for it."""

import math
import random
import unittest

import judged


def noisy(middle, noise, count=27, seed=1):
    chance = random.Random(seed)
    return [middle * math.exp(chance.gauss(0, noise)) for _ in range(count)]


class JudgedTest(unittest.TestCase):
    def test_the_same_ratio_is_good(self):
        self.assertEqual(judged.verdict(1.5, noisy(1.5, 0.05)), judged.GOOD)

    def test_a_ratio_that_is_better_is_good(self):
        self.assertEqual(judged.verdict(1.5, noisy(0.9, 0.05)), judged.GOOD)

    def test_a_ratio_that_was_not_written_is_unknown(self):
        self.assertEqual(judged.verdict(None, [3.0] * 9), judged.UNKNOWN)

    def test_a_fifth_more_is_worse(self):
        self.assertEqual(judged.verdict(1.5, noisy(1.8, 0.05)), judged.WORSE)

    def test_a_tenth_more_is_within_the_limit(self):
        self.assertEqual(judged.verdict(1.5, noisy(1.65, 0.02)), judged.GOOD)

    def test_noise_is_not_called_worse(self):
        verdicts = [judged.verdict(1.5, noisy(1.5, 0.5, seed=seed)) for seed in range(300)]
        self.assertLessEqual(verdicts.count(judged.WORSE), 6)

    def test_a_ratio_above_the_limit_amid_noise_is_undecided(self):
        self.assertEqual(judged.verdict(1.5, [0.9, 1.2, 1.4, 1.8, 1.9, 2.0, 2.5, 3.0, 3.0]), judged.UNDECIDED)

    def test_a_median_amid_noise_is_not_written(self):
        self.assertTrue(judged.is_close(noisy(1, 0.1)))
        self.assertFalse(judged.is_close(noisy(1, 0.8)))

    def test_the_bounds_of_the_median_grow_closer_with_more_ratios(self):
        def width(count):
            low, _, high = judged.median_within(noisy(1, 0.3, count))
            return high - low
        self.assertLess(width(100), width(9) / 2)

    def test_the_bounds_of_nine_are_the_least_and_the_largest(self):
        self.assertEqual(judged.median_within(range(9)), (0, 4, 8))

    def test_the_bounds_of_twenty_seven_leave_out_seven_at_each_end(self):
        self.assertEqual(judged.median_within(range(27)), (7, 13, 19))


if __name__ == "__main__":
    unittest.main()
