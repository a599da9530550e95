#!/usr/bin/env python3
"""What outcomes.py finds missing or wrong in ledgers, and that it finds nothing in complete ones."""

import pathlib
import tempfile
import unittest

import outcomes  # also makes the modules of ../integration known
from sight import Sight

NODES = ["a", "b"]


def begun(node, at=1):
    return f"{at} start node={node} life={at} room=5"


def met(other, at=10, number=1):
    return [f"{at} state_posted message=State0 number={number}", f"{at} peer node={other} state=UP heard_s=0",
            f"{at} tick from={other} number=1 age_s=0", f"{at} state from={other} message=State0 number={number} age_s=0"]


def command(other, number, outcome="delivered"):
    return [f"{20 + number} accepted to={other} id={number}", f"{30 + number} outcome to={other} id={number} is=\"{outcome}\""]


def counted(other, accepted, delivered, in_doubt=0):
    return [f"90 link to={other} accepted={accepted} delivered={delivered} expired=0 in_doubt={in_doubt} undeliverable=0 "
            "outbox=0 resent=0"]


class OutcomesTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.sights = {}

    def write(self, node, *lines):
        path = pathlib.Path(self._folder.name, node)
        with open(path, "a", encoding="utf-8") as file:
            file.writelines(line + "\n" for line in lines)
        self.sights.setdefault(node, Sight(path)).read()

    def both(self, *more):
        """Two nodes that have met; `more`: further lines of a."""
        self.write("a", begun("a"), *met("b"), *more)
        self.write("b", begun("b"), *met("a"))

    def found(self, words, missing):
        self.assertEqual([words in text for text in missing], [True], missing)

    def test_nodes_that_have_met(self):
        self.both()
        self.assertEqual(outcomes.not_met(self.sights, NODES), [])

    def test_a_node_that_was_lost_again(self):
        self.both("11 peer node=b state=LOST heard_s=3")
        self.found("a shows b LOST", outcomes.not_met(self.sights, NODES))

    def test_a_node_that_shows_nobody(self):
        self.write("a", begun("a"), *met("b"))
        self.write("b", begun("b"), "2 state_posted message=State0 number=1")
        self.assertEqual(outcomes.not_met(self.sights, NODES), ["b shows a not at all", "b has no pose of this life of a",
                                                                "b has no State0 of this life of a"])

    def test_a_pose_and_a_state_of_an_earlier_life(self):
        self.both()
        self.write("b", begun("b", 50), *met("a", 51))
        self.assertEqual(outcomes.not_met(self.sights, NODES),
                         ["a has no pose of this life of b", "a has no State0 of this life of b"])

    def test_a_killed_node_has_not_met_until_it_lives_again(self):
        self.both()
        self.sights["b"].await_life()
        self.assertEqual(len(outcomes.not_met(self.sights, NODES)), 5)
        self.write("b", begun("b", 50), *met("a", 51))
        self.write("a", *met("b", 52))
        self.assertEqual(outcomes.not_met(self.sights, NODES), [])

    def test_an_old_state(self):
        self.both()
        self.write("b", "12 state_posted message=State0 number=2")
        self.found("a shows State0 1 of b, which posted 2", outcomes.old_states(self.sights, NODES))

    def test_a_post_that_was_ordered(self):
        self.both()
        self.found("b posted 1 States", outcomes.unposted(self.sights, NODES, {"a": 1, "b": 2}))

    def test_commands_that_are_not_accepted_or_have_no_outcome(self):
        self.both(*command("b", 1))
        ordered = {"a": 2, "b": 0}
        self.found("a has had 1 commands to b accepted", outcomes.not_accepted(self.sights, NODES, ordered))
        self.found("a knows outcomes of 1 commands to b", outcomes.unanswered(self.sights, NODES, ordered))
        self.write("a", *command("b", 2))
        self.assertEqual(outcomes.not_accepted(self.sights, NODES, ordered), [])
        self.assertEqual(outcomes.unanswered(self.sights, NODES, ordered), [])

    def test_commands_of_an_earlier_life_do_not_count(self):
        self.both(*command("b", 1))
        self.write("a", begun("a", 50))
        self.found("outcomes of 0 commands", outcomes.unanswered(self.sights, NODES, {"a": 1, "b": 0}))

    def test_an_outcome_other_than_delivered(self):
        self.both(*command("b", 1, "in doubt"), *command("b", 2))
        self.assertEqual(outcomes.undelivered(self.sights, NODES, 1), [])
        self.found("command 1 to b: in doubt", outcomes.undelivered(self.sights, NODES, 2))

    def test_counters_that_do_not_tell_each_outcome(self):
        self.both(*command("b", 1), *command("b", 2), *counted("b", 2, 1))
        self.found("2 accepted, 1 with an outcome", outcomes.unsettled(self.sights, NODES))
        self.write("a", *counted("b", 2, 1, 1))
        self.assertEqual(outcomes.unsettled(self.sights, NODES), [])

    def test_what_strays_between_fleet_and_stranger(self):
        self.both()
        for line in ("60 peer node=a state=UP heard_s=0", "60 tick from=a number=1 age_s=0",
                     "60 state from=a message=State0 number=1 age_s=0", "60 delivered from=a life=1 id=1 octets=1"):
            self.sights.pop("s", None)
            pathlib.Path(self._folder.name, "s").unlink(missing_ok=True)
            self.write("s", begun("s"), *met("t"))
            self.assertEqual(outcomes.strayed(self.sights, [NODES, ["s"]]), [])
            self.write("s", line)
            self.assertEqual(outcomes.strayed(self.sights, [NODES, ["s"]]), ["s heard of a"])
        self.write("a", "61 delivered from=s life=1 id=1 octets=1")
        self.assertEqual(outcomes.strayed(self.sights, [NODES, ["s"]]), ["a heard of s", "s heard of a"])
        self.write("a", begun("a", 70))
        self.assertIn("a heard of s", outcomes.strayed(self.sights, [NODES, ["s"]]))


if __name__ == "__main__":
    unittest.main()
