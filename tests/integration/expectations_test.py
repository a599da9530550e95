#!/usr/bin/env python3
"""Expectations find what is wrong, and have nothing against what is right."""

import unittest

import expectations
import judge

S = 1_000_000_000


def run(faults=(), **ledgers):
    """`ledgers`: for each node the lines of one life, (second, rest)"""
    made = expectations.Run({}, list(faults))
    made.lives = {node: judge.read_ledger([f"{S} start node={node} life=1 room=5\n"]
                                          + [f"{int(at * S)} {rest}\n" for at, rest in lines])
                  for node, lines in ledgers.items()}
    made.ended = 100
    return made


def busy(made, begin, end, seconds):
    """The machine took so many seconds of those between begin and end, evenly."""
    made.waited = lambda first, last: seconds * max(0, min(last, end) - max(first, begin)) / (end - begin)
    return made


def taken(*times):
    return [(at, f"delivered from=a life=1 id={number}") for number, at in enumerate(times, 1)]


def accepted(*times):
    return [(at, f"accepted to=b id={number}") for number, at in enumerate(times, 1)]


class AgesTest(unittest.TestCase):
    POSTED = [(10, "state_posted message=State0 number=1")]

    def ages(self, shown_s, at=10.5, waited=(0, 1, 0)):
        seen = [(at, f"state from=a message=State0 number=1 age_s={shown_s}")]
        return expectations.honest_ages(busy(run(a=self.POSTED, b=seen), *waited), 0.1)

    def test_accepts_a_right_age(self):
        self.assertEqual(self.ages(0.45), [])

    def test_finds_an_age_that_is_too_small(self):
        self.assertIn("age 0.300 s shown, posted 0.500 s before", self.ages(0.3)[0])

    def test_finds_an_age_that_is_too_large(self):
        self.assertEqual(len(self.ages(3600.5)), 1)

    def test_accepts_an_age_that_is_too_small_by_what_the_machine_took_before_the_line(self):
        self.assertEqual(self.ages(0.3, waited=(10, 10.5, 0.2)), [])

    def test_finds_an_age_that_is_too_small_though_the_machine_was_busy_before(self):
        self.assertEqual(len(self.ages(19, at=30, waited=(11, 28, 20))), 1)

    def test_finds_an_age_that_is_too_large_though_the_machine_is_busy(self):
        self.assertEqual(len(self.ages(0.7, waited=(10, 10.5, 5))), 1)

    def test_finds_a_node_whose_states_are_never_seen(self):
        self.assertEqual(expectations.honest_ages(run(a=self.POSTED, b=[]), 0.1), ["b saw no State of a"])


class TurnsTest(unittest.TestCase):
    def test_accepts_a_pause_in_which_nothing_waits(self):
        self.assertEqual(expectations.starved_at_most(run(a=accepted(2, 20), b=taken(3, 21)), 5), [])

    def test_finds_a_sender_without_a_turn(self):
        self.assertEqual(expectations.starved_at_most(run(a=accepted(2, 3), b=taken(3, 21)), 5),
                         ["a to b: 18.0 s without a turn, at most 5 s wanted"])


    def test_leaves_out_the_time_that_the_machine_took(self):
        fleet = run(a=accepted(2, 3), b=taken(3, 21))
        self.assertEqual(expectations.starved_at_most(busy(fleet, 3, 21, 14), 5), [])
        self.assertEqual(len(expectations.starved_at_most(busy(fleet, 3, 21, 12), 5)), 1)


class CutTest(unittest.TestCase):
    FAULTS = [(10, "cut", ["a"]), (20, "heal", [])]
    CUT = (2, "UP"), (11.5, "STALE"), (13.5, "LOST")

    def timely(self, *said, notes=(), ended=100, waited=(20, 30, 0)):
        made = run(self.FAULTS, a=[(at, f"intent to=b id={number}") for number, at in enumerate(notes, 1)],
                   b=[(at, f"peer node=a state={state}") for at, state in said] + taken(*notes))
        made.ended = ended
        return expectations.timely(busy(made, *waited), "b")

    def test_accepts_a_cut_and_a_return_that_are_seen_soon(self):
        self.assertEqual(self.timely(*self.CUT, (22, "UP"), notes=(3, 22)), [])

    def test_finds_a_cut_that_is_never_seen(self):
        self.assertEqual(len(self.timely((2, "UP"))), 3)

    def test_finds_a_cut_that_is_never_seen_on_a_busy_machine(self):
        self.assertEqual(len(self.timely((2, "UP"), (22, "UP"), waited=(10, 20, 40))), 2)

    def test_finds_a_node_that_is_never_up_again_in_a_run_that_ends_soon(self):
        self.assertEqual(self.timely(*self.CUT, ended=26), ["a cut for 10 s: b saw it UP never, at most 15.0 s wanted"])

    def test_finds_a_link_that_never_delivers_again_in_a_run_that_ends_soon(self):
        self.assertEqual(self.timely(*self.CUT, (22, "UP"), notes=(3,), ended=26),
                         ["a cut for 10 s: first note from a to b never, at most 15.0 s wanted"])

    def test_finds_a_return_that_is_late_by_more_than_the_machine_took(self):
        late = *self.CUT, (40, "UP")
        self.assertEqual(len(self.timely(*late)), 1)
        self.assertEqual(len(self.timely(*late, waited=(20, 30, 4))), 1)
        self.assertEqual(self.timely(*late, waited=(20, 30, 6)), [])


class TicksTest(unittest.TestCase):
    def test_counts_from_when_the_last_of_several_losses_was_made(self):
        seen = [(at, f"tick from=b number={at}") for at in range(2, 20)]
        seen += [(at, f"tick from=b number={at}") for at in range(20, 100, 2)]
        lossy = run([(4, "lose", [20, ["c"]]), (9, "lose", [50, ["b"]]), (19, "wait", [80])], a=seen, b=[])
        share, span, taken = lossy.share_of_ticks("a", "b")
        self.assertEqual((round(share, 1), span, taken), (0.5, 79, 0))

    def ticks(self, waited_s):
        seen = [(2 + number / 10, f"tick from=b number={number}") for number in range(0, 100) if number % 5]
        return expectations.ticks(busy(run(a=seen, b=seen[:1]), 2, 12, waited_s), {"a": 0})

    def test_finds_ticks_that_are_missing(self):
        self.assertTrue(any("a saw 81 % of" in text for text in self.ticks(0)), self.ticks(0))

    def test_accepts_as_many_missing_as_the_machine_took(self):
        self.assertEqual([text for text in self.ticks(1.5) if "%" in text], [])


class WordsTest(unittest.TestCase):
    def test_finds_a_problem_by_its_words(self):
        seen = run(b=[(2, 'problem node=a subject="a" reason="two live nodes have this name"')])
        self.assertEqual(len(expectations.no_problem(seen, ["this name"])), 1)
        self.assertEqual(expectations.no_problem(seen, ["no announcement"]), [])


class BeginningTest(unittest.TestCase):
    def begin(self, *seen, waited_s=0):
        """a starts at 1 s and again at 10 s, and sees b; b has seen ticks of a at these times."""
        made = run(b=[(at, f"tick from=a number=1 age_s=0") for at in seen], a=[(2, "tick from=b number=1 age_s=0")])
        made.lives["a"] += judge.read_ledger([f"{10 * S} start node=a life=10 room=5\n"])
        made.lives["b"][0].begin = 0
        return expectations.ticks_begin_within(busy(made, 10, 100, waited_s), 1.5)

    def test_accepts_a_life_that_is_seen_soon(self):
        self.assertEqual(self.begin(1.4, 11.4), [])

    def test_finds_a_life_that_is_seen_late(self):
        self.assertEqual(self.begin(1.4, 9, 11.6), ["b saw no tick of a within 1.5 s after its start"])

    def test_finds_a_life_that_is_never_seen_on_a_busy_machine(self):
        self.assertEqual(self.begin(1.4, 9, waited_s=200), ["b saw no tick of a within 1.5 s after its start"])


class ReturnTest(unittest.TestCase):
    FAULTS = [(10, "kill", ["a"]), (11, "start", ["a"])]

    def back(self, *said):
        return expectations.back_within(run(self.FAULTS, a=[], b=[(at, f"peer node=a state={state}") for at, state in said]), 4)

    def test_accepts_a_node_that_is_soon_up(self):
        self.assertEqual(self.back((2, "UP"), (13, "LOST"), (14, "UP")), [])

    def test_finds_a_node_that_is_up_too_late(self):
        self.assertEqual(len(self.back((2, "UP"), (13, "LOST"), (16, "UP"))), 1)

    def test_finds_a_node_that_does_not_stay_up(self):
        self.assertEqual(len(self.back((2, "UP"), (30, "STALE"), (31, "UP"))), 1)


class StatesTest(unittest.TestCase):
    def stale(self, waited_s, expected):
        seen = run(a=[(2, "peer node=b state=UP"), (9, "peer node=b state=STALE"), (9.5, "peer node=b state=UP")], b=[])
        return expectations.states(busy(seen, 6, 9, waited_s), {"a": {"b": expected}})

    def test_a_silence_is_wrong_unless_the_machine_explains_it(self):
        self.assertEqual(len(self.stale(0.1, ["UP"])), 1)
        self.assertEqual(self.stale(1, ["UP"]), [])

    def test_a_silence_that_is_expected_may_be_explained_by_the_machine_as_well(self):
        for waited_s in 0.1, 1:
            self.assertEqual(self.stale(waited_s, ["UP", "STALE", "UP"]), [])

    def test_a_star_is_each_node_that_is_not_named(self):
        seen = run(a=[(2, "peer node=b state=UP")], b=[(2, "peer node=a state=UP"), (3, "peer node=a state=STALE")])
        self.assertEqual(expectations.states(seen, {"*": {"*": ["UP"]}}), ["b saw a as ['UP', 'STALE'], not ['UP']"])
        self.assertEqual(expectations.states(seen, {"*": {"*": ["UP"]}, "b": {"a": ["UP", "STALE"]}}), [])


if __name__ == "__main__":
    unittest.main()
