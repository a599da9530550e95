#!/usr/bin/env python3
"""Expectations find what is wrong, and have nothing against what is right."""

import pathlib
import tempfile
import types
import unittest

import expectations
import judge
import run_scenario
import sight

S = 1_000_000_000


def ledger(node, lines, begin=1):
    return "".join([f"{begin * S} start node={node} life={begin} room=5\n"] + [f"{int(at * S)} {rest}\n" for at, rest in lines])


def run(**ledgers):
    """`ledgers`: for each node the lines of one life, (second, rest)"""
    made = expectations.Run({}, [])
    made.lives = {node: judge.read_ledger(ledger(node, lines)) for node, lines in ledgers.items()}
    return made


class AgesTest(unittest.TestCase):
    POSTED = [(10, "state_posted message=State0 number=1")]

    def ages(self, shown_s):
        seen = [(10.5, f"state from=a message=State0 number=1 age_s={shown_s}")]
        return expectations.honest_ages(run(a=self.POSTED, b=seen), 0.1)

    def test_accepts_a_right_age(self):
        self.assertEqual(self.ages(0.45), [])

    def test_finds_an_age_that_is_too_small(self):
        self.assertIn("age 0.300 s shown, posted 0.500 s before", self.ages(0.3)[0])

    def test_finds_an_age_that_is_too_large(self):
        self.assertEqual(len(self.ages(3600.5)), 1)

    def test_finds_a_node_whose_states_are_never_seen(self):
        self.assertEqual(expectations.honest_ages(run(a=self.POSTED, b=[]), 0.1), ["b saw no State of a"])


class LastStatesTest(unittest.TestCase):
    POSTED = [(10, "state_posted message=State0 number=1"), (11, "state_posted message=State0 number=2")]

    def shown(self, *numbers, posted=True):
        seen = [(2, "peer node=a state=UP")] + [(12 + at, f"state from=a message=State0 number={number} age_s=0")
                                                for at, number in enumerate(numbers)]
        return expectations.last_states(run(a=self.POSTED if posted else [], b=seen), True)

    def test_accepts_the_last_one_whichever_came_before(self):
        self.assertEqual(self.shown(1, 2), [])
        self.assertEqual(self.shown(2), [])
        self.assertEqual(self.shown(posted=False), [])

    def test_finds_an_older_one_at_the_end(self):
        self.assertEqual(self.shown(1), ["b and State0 of a: shows 1 at the end, not 2"])
        self.assertEqual(self.shown(), ["b and State0 of a: shows nothing at the end, not 2"])

    def test_finds_one_that_goes_back(self):
        self.assertEqual(self.shown(2, 1, 2), ["b and State0 of a: went back: [2, 1, 2]"])


class RefusalsTest(unittest.TestCase):
    def refused(self, accepted, refused=1):
        lines = [(2, "refused to=b id=0")] + [(3, "accepted to=b id=1")] * accepted + [(4, "refused to=b id=2")] * refused
        return expectations.refusals_from(run(a=lines, b=[]), {"a to b": [2, 3]})

    def test_accepts_a_first_refusal_within_the_bounds(self):
        self.assertEqual(self.refused(2) + self.refused(3), [])

    def test_finds_an_early_a_late_and_a_missing_refusal(self):
        self.assertEqual(self.refused(1), ["a to b: refused after 1 accepted, 2 to 3 wanted"])
        self.assertEqual(self.refused(4), ["a to b: refused after 4 accepted, 2 to 3 wanted"])
        self.assertEqual(self.refused(2, 0), ["a to b: nothing refused, 2 to 3 wanted"])


class WordsTest(unittest.TestCase):
    SAID = 'problem node=a subject="a" reason="two live nodes have this name"'

    def test_finds_a_problem_by_its_words(self):
        seen = run(b=[(2, self.SAID)])
        self.assertEqual(len(expectations.no_problem(seen, ["this name"])), 1)
        self.assertEqual(expectations.no_problem(seen, ["no announcement"]), [])


class AwaitedTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name, "b")

    def awaited(self, wanted, *lines):
        self.path.write_text(ledger("b", lines), encoding="utf-8")
        one = sight.Sight(self.path)
        one.read()
        return expectations.awaited({"b": one}, wanted)

    def test_a_problem_is_awaited_until_it_is_reported(self):
        wanted = {"problems": {"b": "have this name"}}
        self.assertEqual(self.awaited(wanted), ["b did not report 'have this name', but []"])
        self.assertEqual(self.awaited(wanted, (2, WordsTest.SAID)), [])

    def test_a_foreign_sample_is_awaited_until_it_is_counted(self):
        wanted = {"foreign_refused": ["b"]}
        for values in ("from= undecodable=0 refused=0", "from=a undecodable=0 refused=3"):
            self.assertEqual(len(self.awaited(wanted, (2, f"topic message=Tick {values}"))), 1)
        self.assertEqual(self.awaited(wanted, (2, "topic message=Tick from= undecodable=0 refused=1")), [])

    def test_a_refusal_counts_once_a_note_was_accepted(self):
        for lines, refused in (((2, "refused to=a id=1"), (3, "accepted to=a id=2")), 0), \
                (((2, "accepted to=a id=1"), (3, "refused to=a id=2")), 1):
            self.path.write_text(ledger("b", lines), encoding="utf-8")
            one = sight.Sight(self.path)
            one.read()
            self.assertEqual(one.refused["a"], refused)


class FleetTest(unittest.TestCase):
    """A fleet whose ledgers the test writes."""

    class Program:
        lines = [(0, "ready")]
        told = []
        runs = True

        def running(self):
            return self.runs

        def tell(self, line):
            self.told.append(line)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.processes = {"a": self.Program(), "b": self.Program()}
        nodes = {"a": ["--to", "b", "--count", "1", "--orders"], "b": ["--states", "1", "--state-posts", "2"]}
        field = types.SimpleNamespace(folder=folder.name, processes=self.processes)
        self.fleet = run_scenario.Fleet(field, "program", None, {"nodes": nodes})
        self.fleet.running = set(nodes)
        self.faults = run_scenario.Faults(self.fleet)

    def write(self, node, *lines):
        with open(self.fleet.paths()[node], "a", encoding="utf-8") as file:
            file.write(ledger(node, lines) if file.tell() == 0 else "".join(f"{at * S} {rest}\n" for at, rest in lines))

    def missing(self, what):
        with self.assertRaises(run_scenario.NeverSeen) as raised:
            self.fleet.until(what, 0)
        return list(raised.exception.args)

    def settled(self, accepted, outbox=0):
        return (9, f"link to=b accepted={accepted} delivered={accepted - outbox} expired=0 in_doubt=0 undeliverable=0 "
                   f"outbox={outbox} resent=0")

    def test_waits_for_nodes_that_have_not_met(self):
        self.write("a", (2, "peer node=b state=UP heard_s=0"))
        self.write("b", (2, "peer node=a state=STALE heard_s=2"))
        self.assertEqual(self.missing(self.fleet.not_met), ["b shows a STALE"])
        self.write("b", (3, "peer node=a state=UP heard_s=0"))
        self.faults.run([["meet"], ["shows", "b", "a", "UP"], ["says", "a", "ready"]])

    def test_waits_for_notes_and_States(self):
        self.write("a", self.settled(1, 1))
        self.write("b", (2, "state_posted message=State0 number=1"))
        self.assertEqual(sorted(self.missing(self.fleet.unsettled)), ["a to b: 1 of 1 accepted, 1 open", "b: 1 of 2 States posted"])
        self.write("a", self.settled(1))
        self.write("b", (3, "state_posted message=State0 number=2"))
        self.faults.run([["settle"], ["counted", "a", "delivered", 1], ["order", "a", "notes 2"]])
        self.assertEqual(self.processes["a"].told, ["notes 2"])
        self.assertEqual(self.missing(self.fleet.unsettled), ["a to b: 1 of 3 accepted, 0 open"])

    def test_waits_no_longer_for_a_node_that_has_ended(self):
        self.processes["b"].runs = False
        with self.assertRaises(run_scenario.NeverSeen) as raised:
            self.faults.run([["reports", "a", "a problem"]])
        self.assertEqual(raised.exception.args, ("a did not report 'a problem', but []", "b ended by itself"))


if __name__ == "__main__":
    unittest.main()
