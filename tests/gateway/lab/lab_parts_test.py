#!/usr/bin/env python3
"""The parts of the lab that decide: scenarios with mistakes, expectations on flights that are made up, loss by distance, and
the files that a run leaves."""

import contextlib
import dataclasses
import io
import pathlib
import sys
import tempfile
import types
import unittest
from unittest import mock
from xml.etree import ElementTree

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "gateway" / "lab"))
# pylint: disable=wrong-import-position
from rabit_lab import flight as flights  # noqa: E402
from rabit_lab import junit, keys, main, new, nodes, places, plots, processes, real_time, report, scenario, table, tools, units, what_if  # noqa: E402
from rabit_lab.marked import ScenarioError  # noqa: E402

FLEET = """nodes:
  uav*: {count: 2, command: [sh, "{node}"]}
  ground: {command: [sh]}
"""


class InFolder(unittest.TestCase):
    """Each test has a folder of its own."""

    def setUp(self):
        # pylint: disable=consider-using-with
        self._made = tempfile.TemporaryDirectory()
        self.addCleanup(self._made.cleanup)
        self.folder = pathlib.Path(self._made.name)

    def read(self, more="", fleet=FLEET):
        path = self.folder / "s.yaml"
        path.write_text(fleet + more, encoding="utf-8")
        return scenario.read(path)

    def refused(self, line, words, more="", fleet=FLEET):
        with self.assertRaises(ScenarioError) as caught:
            self.read(more, fleet)
        self.assertTrue(str(caught.exception).startswith(f"{self.folder / 's.yaml'}:{line}: "), str(caught.exception))
        self.assertIn(words, str(caught.exception))


class ScenarioTest(InFolder):
    def test_a_pattern_with_a_count_is_so_many_nodes(self):
        read = self.read()
        self.assertEqual(list(read.nodes), ["uav1", "uav2", "ground"])
        self.assertEqual(read.nodes["uav2"].command[1], "uav2")
        self.assertEqual(read.networks["lan"].members, ["uav1", "uav2", "ground"])

    def test_units_of_a_network_are_read(self):
        radio = self.read("network:\n  radio: {rate: 250kbit/s, loss: 10%, burst: 4, delay: 20ms, queue: 16kB}\n").networks["radio"]
        self.assertEqual((radio.rate, radio.loss, radio.burst, radio.delay, radio.queue), (250000, 10, 4, 0.02, 16000))

    def test_a_node_with_an_image_needs_no_command(self):
        self.assertEqual(self.read(fleet="nodes:\n  uav: {image: debian}\n").nodes["uav"].command, [])

    def test_a_full_disk_is_refused_for_a_node_with_an_image(self):
        self.refused(4, "has an image", "events:\n  - {at: 1s, disk: {node: uav, full: true}}\n",
                     "nodes:\n  uav: {image: debian}\n")

    def test_a_mistake_is_named_with_its_line(self):
        cases = [
            (4, "did you mean `network`", "netwrk: {}\n"),
            (5, "did you mean `loss`", "network:\n  radio: {los: 10%}\n"),
            (5, "a share such as 10%", "network:\n  radio: {loss: 10}\n"),
            (5, "is no name of a network", "network:\n  Radio Link: {}\n"),
            (4, "ground is in no network", "network:\n  radio: {members: \"uav*\"}\n"),
            (5, "there is no node `uav3`", "events:\n  - {at: 1s, kill: uav3}\n"),
            (5, "did you mean `kill`", "events:\n  - {at: 1s, kil: uav2}\n"),
            (5, "an event has `at`", "events:\n  - {kill: uav2}\n"),
            (5, "the run ends at 30 s", "events:\n  - {at: 40s, kill: uav2}\n"),
            (5, "the event kill has no `for`", "events:\n  - {at: 1s, kill: uav2, for: 3s}\n"),
            (5, "step", "events:\n  - {at: 1s, clock: {node: uav1}}\n"),
            (5, "is no queue", "events:\n  - {at: 1s, send: uav1, type: A}\n"),
            (5, "delivered within 2s", "events:\n  - {at: 1s, send: uav1/Q, type: A, expect: quickly}\n"),
            (5, "is no expectation; they are, for instance: all up within 3s", "expect:\n  - all up\n"),
            (5, "for instance: uav*/Pose at ground: age p90 < 0.5s, after 20s", "expect:\n  - \"Pose at ground: age p90 < 1s\"\n"),
            (5, "network radio has no `mode`; it may have members, rate", "network:\n  radio: {mode: lora}\n"),
            (5, "there is no node `uav9`", "expect:\n  - uav9 up within 1s\n"),
            (5, "the run ends at 30 s", "expect:\n  - uav1 up within 1s after 30s\n"),
            (5, "age p90 < 0.5s", "expect:\n  - \"uav1/Pose at ground: speed > 3\"\n"),
            (5, "there is no file", "network:\n  radio: {range: {from: track.csv, metres: 800}}\n"),
        ]
        for line, words, more in cases:
            with self.subTest(more):
                self.refused(line, words, more)

    KEYED = ("nodes:\n  uav*: {count: 2, command: [sh], keys: \"{node}.yaml\"}\n  ground: {command: [sh], keys: ground.yaml}\n"
             "  plain1: {command: [sh]}\n  plain2: {command: [sh]}\n")

    def read_keyed(self, more=""):
        for name in ("uav1", "uav2", "ground"):
            (self.folder / f"{name}.yaml").write_text("", encoding="utf-8")
        return self.read(more, self.KEYED)

    def test_nodes_with_keys_and_nodes_without_do_not_hear_each_other(self):
        read = self.read_keyed()
        self.assertEqual(read.nodes["uav2"].keys, str(self.folder.resolve() / "uav2.yaml"))
        self.assertTrue(read.share_network("uav1", "ground"))
        self.assertTrue(read.share_network("plain1", "plain2"))
        self.assertFalse(read.share_network("uav1", "plain1"))

    def test_a_node_that_can_have_no_keys_is_named(self):
        for words, node in (("has an image", "image: debian, keys: s.yaml"), ("is no Rabit node", "command: [sh], plain: true, keys: s.yaml"),
                            ("there is no file", "command: [sh], keys: none.yaml")):
            with self.subTest(words):
                self.refused(2, words, fleet=f"nodes:\n  uav: {{{node}}}\n")

    def made_keys(self, read, code=0):
        """What keys.make returns, and the calls of `rabit`."""
        rabit = self.folder / "rabit"
        rabit.write_text(f'#!/bin/sh\necho "$@" >>{self.folder}/calls\necho "rabit: no such type" >&2\nexit {code}\n', encoding="utf-8")
        rabit.chmod(0o755)
        made = keys.make(read, self.folder, str(rabit))
        calls = self.folder / "calls"
        return made, calls.read_text(encoding="utf-8").splitlines() if calls.exists() else []

    def test_each_node_gets_keys_for_its_configuration_and_each_tool_some_of_its_own(self):
        read = self.read_keyed("network:\n  radio: {}\nobserve: radio\nevents:\n  - {at: 1s, send: uav1/Q, type: A}\n"
                               "  - {at: 2s, send: uav1/Q, type: A, options: [--node, ops]}\n"
                               "  - {at: 3s, send: plain1/Q, type: A, from: plain2}\n")
        made, calls = self.made_keys(read)
        self.assertEqual(list(made), ["uav1", "uav2", "ground", "observer", "lab.send1", "ops"])
        self.assertEqual(made["uav1"], self.folder / "keys" / "uav1")
        self.assertEqual(calls[:2], [f"keys init {self.folder}/keys",
                                     f"keys add uav1 --keys {self.folder}/keys --config {self.folder.resolve()}/uav1.yaml"])
        self.assertEqual(calls[-1], f"keys add ops --keys {self.folder}/keys --tool")
        self.assertEqual([keys.sender(read, event) for event in read.events], ["lab.send1", "ops", "lab.send3"])

    def test_a_fleet_without_keys_gets_none(self):
        self.assertEqual(self.made_keys(self.read("events:\n  - {at: 1s, send: uav1/Q, type: A}\n")), ({}, []))

    def test_keys_that_cannot_be_made_are_a_mistake_of_the_scenario(self):
        with self.assertRaises(ScenarioError) as caught:
            self.made_keys(self.read_keyed(), 2)
        self.assertEqual(str(caught.exception), f"{self.folder / 's.yaml'}:2: keys: no such type")

    def test_a_node_learns_of_its_keys_by_the_environment(self):
        read = self.read_keyed()
        given = {}
        spaces = types.SimpleNamespace(start=lambda place, argv, env: (given.update({place: env}), (argv, env))[1])
        nets = types.SimpleNamespace(addresses=lambda place: ["10.77.0.1"], spaces=spaces)
        with mock.patch("rabit_lab.processes.Process"):
            started = nodes.Nodes(read, nets, flights.Flight(read), self.folder, None, lambda: 0.0, {"uav1": self.folder / "keys" / "uav1"})
            started.start("uav1")
            started.start("plain1")
        self.assertEqual(given["uav1"]["RABIT_NODE_KEYS"], str(self.folder / "keys" / "uav1"))
        self.assertNotIn("RABIT_NODE_KEYS", given["plain1"])

    def test_the_keys_of_the_labs_user_reach_no_child(self):
        def lines_of(env):
            child = processes.Process(["env"], env)
            self.assertEqual(child.exit_code(60), 0)
            return [text for _, text in child.lines]
        with mock.patch.dict("os.environ", {"RABIT_KEYS": "mine", "RABIT_NODE_KEYS": "mine", "RABIT_DOMAIN": "7"}):
            self.assertEqual([line for line in lines_of(None) if line.startswith("RABIT_")], ["RABIT_DOMAIN=7"])
            self.assertIn("RABIT_NODE_KEYS=of/the/node", lines_of({"RABIT_NODE_KEYS": "of/the/node"}))

    def test_an_autopilot_runs_beside_its_node_and_no_pattern_of_nodes_means_it(self):
        fleet = "nodes:\n  uav*: {count: 2, command: [sh, \"{mavlink}\"], autopilot: {kind: px4-sih, over: dds, options: [\"{node}\"]}}\n"
        (self.folder / "etc").mkdir()
        with mock.patch("shutil.which", lambda program: f"{self.folder}/bin/{program}"):
            read = self.read("network:\n  radio: {members: \"*\"}\nevents:\n  - {at: 1s, kill: \"*\"}\n"
                             "  - {at: 2s, kill: [\"uav1.*\"]}\n  - {at: 3s, kill: [\"*.autopilot\"]}\n", fleet)
        self.assertEqual(list(read.nodes), ["uav1", "uav2", "uav1.agent", "uav1.autopilot", "uav2.agent", "uav2.autopilot"])
        pilot = read.nodes["uav2.autopilot"]
        self.assertEqual(pilot.command, [f"{self.folder}/bin/px4", "-d", "-i", "1", "-w", "{disk}", f"{self.folder}/etc", "uav2"])
        self.assertEqual((pilot.beside, pilot.plain, pilot.env["PX4_UXRCE_DDS_NS"]), ("uav2", True, "uav2"))
        self.assertEqual([read.nodes[name].command[1] for name in ("uav1", "uav2")], ["14540", "14541"])
        self.assertEqual(read.networks["radio"].members, ["uav1", "uav2"])
        self.assertEqual([event.values["nodes"] for event in read.events],
                         [["uav1", "uav2"], ["uav1.agent", "uav1.autopilot"], ["uav1.autopilot", "uav2.autopilot"]])

    def test_a_mistake_with_an_autopilot_is_named_with_its_line(self):
        def which(program):
            return None if program in missing else "/bin/" + program
        fleet = "nodes:\n  uav:\n    command: [sh]\n    autopilot: PILOT\n"
        cases = [
            (4, "node uav, autopilot px4-sih: no program `px4` in PATH; build PX4", "px4-sih", ""),
            (4, "no program `arducopter` in PATH; build ArduPilot", "arducopter", ""),
            (4, "no program `MicroXRCEAgent` in PATH; install", "{kind: arducopter, over: dds}", ""),
            (4, "px4-sih or arducopter, not `ardupilot`", "ardupilot", ""),
            (4, "`over` is mavlink or dds, not `udp`", "{kind: arducopter, over: udp}", ""),
            (4, "did you mean `options`", "{kind: arducopter, option: []}", ""),
            (6, "there is no node `uav.autopilot`", "arducopter", "events:\n  - {at: 1s, cut: [uav.autopilot]}\n"),
        ]
        for line, words, pilot, more in cases:
            missing = ("px4", "MicroXRCEAgent", "arducopter" if "ArduPilot" in words else "")
            with self.subTest(words), mock.patch("shutil.which", which):
                self.refused(line, words, more, fleet.replace("PILOT", pilot))
        (self.folder / "bin").mkdir()
        with mock.patch("shutil.which", lambda program: f"{self.folder}/bin/{program}"):
            self.refused(4, "has no start scripts in", "", fleet.replace("PILOT", "px4-sih"))

    def test_an_autopilot_starts_with_the_first_life_of_its_node(self):
        fleet = "nodes:\n  uav: {command: [sh], start: never, autopilot: {kind: arducopter, over: dds}}\n  late: {command: [sh], start: never}\n"
        with mock.patch("shutil.which", lambda program: "/bin/" + program):
            read = self.read("events:\n  - {at: 9s, start: uav}\n", fleet)
        self.assertEqual([node.start for node in read.nodes.values()], [None] * 4)
        flight = flights.Flight(read)
        spaces = types.SimpleNamespace(start=lambda place, argv, env: (argv, env), ended=lambda name: None, signal=lambda *_: None)
        nets = types.SimpleNamespace(addresses=lambda place: ["10.77.0.1"], spaces=spaces)
        with mock.patch("rabit_lab.processes.Process"):
            started = nodes.Nodes(read, nets, flight, self.folder, None, lambda: 9.0)
            self.assertEqual(flight.lives, [])
            started.start("uav")
            self.assertEqual([(life.node, life.began) for life in flight.lives], [("uav", 9), ("uav.agent", 9), ("uav.autopilot", 9)])
            started.kill("uav.autopilot")
            started.kill("uav")
            started.start("uav")
        self.assertEqual([life.node for life in flight.lives], ["uav", "uav.agent", "uav.autopilot", "uav"])

    def test_programs_beside_a_node_are_not_counted_as_nodes(self):
        fleet = "nodes:\n  uav*: {count: 2, command: [sh], autopilot: {kind: arducopter, over: dds}}\n"
        with mock.patch("shutil.which", lambda program: "/bin/" + program):
            read = self.read("", fleet)
            with contextlib.redirect_stdout(io.StringIO()) as said:
                main.main(["run", str(self.folder / "s.yaml"), "--check"])
        self.assertIn(": 2 nodes, ", said.getvalue())
        self.assertEqual(read.fleet(), ["uav1", "uav2"])
        flight = Made(read).flight
        (self.folder / "scenario.yaml").write_text("x", encoding="utf-8")
        report.write(read, flight, [], False, "", self.folder)
        self.assertIn(" 2 nodes ", (self.folder / "report.html").read_text(encoding="utf-8"))
        self.assertEqual(table.Table(read, flight, io.StringIO()).summary(1.0), "2 of 2 nodes run")

    def test_a_program_that_is_not_there_is_named_before_anything_starts(self):
        self.refused(2, "no program `./build/uav`", fleet="nodes:\n  uav: {command: [./build/uav]}\n")

    def test_a_key_that_is_there_twice_is_refused(self):
        self.refused(3, "is there twice", fleet="nodes:\n  a: {command: [sh]}\n  a: {command: [sh]}\n")

    def test_what_is_no_yaml_is_named_with_its_line(self):
        self.refused(2, "is no YAML", fleet="nodes: [\n")

    def test_the_command_line_ends_with_2_for_a_mistake(self):
        self.assertEqual(main.main(["run", str(self.folder / "none.yaml"), "--check"]), 2)


class Made:
    """A flight of three nodes that is made up."""

    def __init__(self, read, end=30.0):
        self.flight = flights.Flight(read)
        self.flight.end = end
        for node in read.nodes:
            self.life(node, 0.0)

    def life(self, node, began):
        life = flights.Life(node, len(self.flight.lives_of(node)) + 1, began, recorded=True,
                            incarnation=f"{node}{began}")
        self.flight.lives.append(life)
        return life

    def index(self, node):
        return next(i for i, life in enumerate(self.flight.lives) if life.node == node)

    def sees(self, observer, node, time, state, incarnation=None):
        peer = flights.PeerState(state, incarnation or f"{node}0.0", "silent")
        self.flight.peers[self.index(observer), node].put(time, peer)

    def all_up(self, time):
        for one in self.flight.scenario.nodes:
            for other in self.flight.scenario.nodes:
                if one != other:
                    self.sees(one, other, time, "UP")
        return self


class ExpectationTest(InFolder):
    def judge(self, text, make):
        read = self.read(f"expect:\n  - \"{text}\"\n")
        made = Made(read)
        make(made)
        return read.expects[0].verdict(made.flight)

    def test_all_up_fails_for_a_node_that_is_seen_late_or_never(self):
        self.assertTrue(self.judge("all up within 3s", lambda made: made.all_up(2)).good)
        self.assertIn("after 4.0 s", self.judge("all up within 3s", lambda made: made.all_up(4)).detail)
        self.assertIn("never", self.judge("all up within 3s", lambda made: None).detail)

    def test_up_again_means_the_new_incarnation(self):
        def back(incarnation):
            def make(made):
                made.all_up(1)
                life = made.flight.lives_of("uav2")[0]
                life.ended, life.by = 10.0, "kill"
                made.life("uav2", 15.0)
                for node in ("uav1", "ground"):
                    made.sees(node, "uav2", 15.5, "UP", incarnation)
            return make
        self.assertTrue(self.judge("uav2 up within 1s after 15s", back("uav215.0")).good)
        self.assertFalse(self.judge("uav2 up within 1s after 15s", back("uav20.0")).good)

    def test_up_from_the_beginning_counts_nodes_that_start_one_after_the_other(self):
        def started(made):
            made.all_up(1)
            for life in made.flight.lives:
                life.began = 0.2
        self.assertTrue(self.judge("uav2 up within 3s at ground", started).good)

    def test_lost_is_false_only_without_a_fault(self):
        def lost(made):
            made.all_up(1)
            made.sees("ground", "uav1", 12.0, "LOST")

        def lost_before_the_end(made):
            lost(made)
            for life in made.flight.lives:
                life.ended, life.by = 30.1, "end"

        def cut(made):
            lost(made)
            made.flight.faults.append(flights.Fault(8, 20, "cut", ["uav1"], "cut uav1"))

        def cut_long_before(made):
            lost(made)
            made.flight.faults.append(flights.Fault(1, 3, "cut", ["uav1"], "cut uav1"))

        def loss(*nodes):
            def make(made):
                lost(made)
                made.flight.faults.append(flights.Fault(8, 20, "loss", list(nodes), "loss 100 %"))
            return make

        def killed(made):
            lost(made)
            made.flight.lives_of("uav1")[0].ended = 8.5

        def told_late(made):
            made.all_up(1)
            made.flight.lives_of("uav1")[0].ended = 2.0
            made.life("uav1", 11.5)
            made.sees("ground", "uav1", 12.0, "LOST")
        self.assertTrue(self.judge("no false lost", told_late).good)
        self.assertIn("ground lost uav1 at 12.0 s", self.judge("no false lost", lost).detail)
        self.assertFalse(self.judge("no false lost", lost_before_the_end).good)
        self.assertFalse(self.judge("no false lost", cut_long_before).good)
        self.assertTrue(self.judge("no false lost", cut).good)
        self.assertTrue(self.judge("no false lost", loss("uav1", "ground")).good)
        self.assertFalse(self.judge("no false lost", loss("uav1", "uav2")).good)
        self.assertTrue(self.judge("no false lost", killed).good)

    def test_ages_grow_while_nothing_comes_and_name_the_fault(self):
        def stopping(made):
            made.flight.values[made.index("ground"), "uav1", "Pose"] = [(t / 10, t / 10 - 0.01) for t in range(1, 100)]
            made.flight.faults.append(flights.Fault(10, 30, "cut", ["uav1"], "cut uav1"))
        self.assertTrue(self.judge("uav1/Pose at ground: age p90 < 0.2s, before 9s", stopping).good)
        verdict = self.judge("uav1/Pose at ground: age p90 < 0.5s", stopping)
        self.assertFalse(verdict.good)
        self.assertIn("oldest 20.11 s at 30.0 s; `cut uav1` was at 10 s", verdict.detail)
        self.assertFalse(self.judge("uav1/Pose at ground: rate > 8/s", stopping).good)
        self.assertTrue(self.judge("uav1/Pose at ground: rate > 8/s, before 9s", stopping).good)

    def test_a_node_that_records_nothing_fails_what_it_was_to_see(self):
        def silent(made):
            made.flight.lives_of("ground")[0].recorded = False
        self.assertIn("wrote no recording", self.judge("uav1/Pose at ground: age p90 < 1s", silent).detail)

    def test_an_end_by_itself_and_a_wrong_exit_code_are_told(self):
        def ended(made):
            for node, code in (("uav1", 0), ("uav2", 0), ("ground", 3)):
                life = made.flight.lives_of(node)[0]
                life.ended, life.by, life.code = 30.0, "end", code
        self.assertIn("ground ended with 3", self.judge("exit codes: 0", ended).detail)

    def test_words_of_a_node_are_found_in_their_time(self):
        def said(made):
            made.flight.output.append((12.0, "ground", "Mission complete"))
        self.assertTrue(self.judge("ground says mission complete within 5s after 10s", said).good)
        self.assertFalse(self.judge("ground says mission complete within 1s after 10s", said).good)


    def test_the_reason_names_the_fault_of_that_node(self):
        def cut(made):
            made.all_up(1)
            made.sees("ground", "uav1", 9.0, "LOST")
            made.flight.faults.append(flights.Fault(8, 20, "cut", ["uav1"], "cut uav1"))
            made.flight.faults.append(flights.Fault(9, 20, "freeze", ["uav2"], "freeze uav2"))
        self.assertIn("; `cut uav1` was at 8 s", self.judge("uav1 up within 1s after 12s at ground", cut).detail)


class AgeTest(unittest.TestCase):
    def test_the_share_of_time_counts_not_that_of_values(self):
        pieces = [(0.0, 9.0, 0.0), (9.0, 10.0, 0.0)]  # a value each 0 s and 9 s: from 0 to 9, and from 0 to 1
        self.assertAlmostEqual(flights.age_below(pieces, 1.0), 9.0, 3)
        self.assertAlmostEqual(flights.age_below(pieces, 0.2), 1.0, 3)

    def test_times_without_the_observer_are_left_out(self):
        self.assertEqual(flights.without([(2, 3), (5, 20)], 0, 10), [(0, 2), (3, 5)])


class RealTimeTest(InFolder):
    """uav flies from 1 s on, ends at 4 s, and begins anew at 6 s; ground is there all the time, for 10 s."""

    RADIO = what_if.Radio(57600, 12.5, 4, 0.05, 0.02, 8000, 10, 1500.0, 2.0, 7)

    def told(self):
        lives = [("ground", 0, None), ("uav", 1e9, 4e9), ("uav", 6e9, None)]
        return what_if.read("flight.mcap", [{"fact": "flight", "end": 10e9}]
                            + [{"fact": "life", "file": str(n), "node": node, "t": t, "ended": ended}
                               for n, (node, t, ended) in enumerate(lives)], self.RADIO)

    def test_a_recorded_flight_is_a_scenario_with_its_nodes_and_its_radio(self):
        path = self.folder / "s.yaml"
        path.write_text(yaml.safe_dump(real_time.scenario_of("sh", ["flight.mcap"], self.told(), self.RADIO)), encoding="utf-8")
        read = scenario.read(path)
        self.assertEqual(read.run, 10)
        self.assertEqual([(event.at, event.verb, event.values["nodes"]) for event in read.events],
                         [(4, "kill", ["uav"]), (6, "start", ["uav"])])
        self.assertEqual((read.nodes["ground"].start, read.nodes["uav"].start), (0, 1))
        self.assertEqual(read.nodes["uav"].command[1:],
                         [str(pathlib.Path("flight.mcap").resolve()), "--node", "uav", "--life", "{incarnation}", "--budget", "1500.0"])
        radio = read.networks["radio"]
        self.assertEqual((radio.rate, radio.loss, radio.burst, radio.delay, radio.jitter, radio.queue, radio.overhead, radio.seed),
                         (57600, 12.5, 4, 0.05, 0.02, 8000, 10, 7))

    def test_a_replay_says_what_it_does_not_repeat(self):
        self.assertIn("Cuts, losses and freezes of the recorded flight are not repeated", self.told().simulated.notes[0])

    def test_outcomes_of_queue_messages_are_counted_by_their_queue(self):
        flight = Made(self.read()).flight
        for outcome in ("delivered", "delivered", "expired", "refused"):
            flight.take({"fact": "outcome", "t": 1e9, "node": "uav1", "queue": "Orders", "outcome": outcome, "reason": ""},
                        next(n for n, life in enumerate(flight.lives) if life.node == "ground"), lambda time: time / 1e9)
        self.assertEqual(what_if.queue_cells(real_time.queues(flight)[0]),
                         ("ground", "uav1/Orders", 3, 1, 2, "1 expired", "-", "-", "-"))


class ReportTest(InFolder):
    def test_the_lines_of_a_picture_have_the_numbers_of_the_events(self):
        flight = Made(self.read()).flight
        flight.faults += [flights.Fault(20.0, 20.0, "start", ["uav1"], "start uav1"),
                          flights.Fault(10.0, 10.0, "kill", ["uav1"], "kill uav1")]
        self.assertRegex(report.event_rows(flight), ">1</td>.*10 s.*kill uav1.*>2</td>.*20 s.*start uav1")
        self.assertRegex(plots.states(flight), "kill uav1.*>1</text>.*start uav1.*>2</text>")

    def test_the_line_of_what_a_node_sends_breaks_while_it_does_not_run(self):
        flight = Made(self.read()).flight
        flight.air["uav1"] = [(float(time), 1000, 0, 0) for time in (1, 2, 3, 20, 21)]
        self.assertRegex(plots.sends(flight), "d=\"M[^M]*M[^M]*\"")


class WhatIfTest(InFolder):
    """uav posts ten times a second from 1 s on; ground receives every second post, 0.1 s late."""

    RADIO = what_if.Radio(57600, 0, 1, 0, 0, 16000, 0, None, 0, 1)

    def flown(self, more=()):
        posts = [1e9 + n * 1e8 for n in range(90)]
        facts = [{"fact": "flight", "end": 10e9}]
        facts += [{"fact": "life", "file": node, "node": node, "t": 0, "ended": None} for node in ("uav", "ground")]
        facts += [{"fact": "publication", "file": "uav", "t": t, "message": "Pose", "offered": n, "replaced": n // 2}
                  for t, n in ((2e9, 10), (10e9, 90))]
        facts.append({"fact": "values", "file": "uav", "t": 10e9, "node": "uav", "message": "Pose", "at": posts, "posted": posts})
        facts.append({"fact": "values", "file": "ground", "t": 10e9, "node": "uav", "message": "Pose",
                      "at": [post + 1e8 for post in posts[::2]], "posted": posts[::2]})
        facts.append({"fact": "flown", "at": "ground", "node": "uav", "message": "Pose", "arrived": posts, "posted": posts})
        facts.append({"fact": "medium", "t": 10e9, "bytes": 36000, "carried": 90, "dropped": 10, "longest_wait": 1e9})
        return what_if.read("flight.mcap", facts + list(more), self.RADIO)

    @staticmethod
    def posts_at(observer, posts):
        """uav's Health, as posted, and as one observer received all of it at once."""
        return [{"fact": "values", "file": file, "t": 10e9, "node": "uav", "message": "Health", "at": posts, "posted": posts}
                for file in ("uav", observer)]

    def row(self, message, more, after=0):
        return next(row for row in what_if.rows(self.flown(more), after)[0] if row.message == message)

    def test_a_message_that_is_never_posted_is_no_stream(self):
        never = {"fact": "values", "file": "uav", "t": 10e9, "node": "uav", "message": "Never", "at": [], "posted": []}
        self.assertEqual([row.message for row in what_if.rows(self.flown([never]), 0)[0]], ["Pose"])

    def test_posts_before_the_observer_was_there_are_not_lost(self):
        late = {"fact": "life", "file": "late", "node": "late", "t": 5e9, "ended": 8e9}
        row = self.row("Health", [late] + self.posts_at("late", [n * 1e9 for n in range(1, 10)]))
        self.assertEqual((row.posted, row.due, row.arrived), (9, 3, 3))

    def test_a_stream_that_was_not_recorded_has_no_age_as_recorded(self):
        row = self.row("Health", self.posts_at("ground", [1e9, 2e9]))
        self.assertIsNone(row.recorded_p90)
        self.assertIsNotNone(row.p90)

    def test_an_observer_that_was_never_there_has_no_oldest_value(self):
        early = {"fact": "life", "file": "early", "node": "early", "t": 0, "ended": 3e9}
        row = self.row("Health", [early] + self.posts_at("early", [1e9, 2e9]), after=5)
        self.assertEqual((row.worst, row.where), (None, "-"))

    def test_counting_from_beyond_the_end_is_refused(self):
        radio = dataclasses.replace(self.RADIO, after=20)
        with self.assertRaisesRegex(ScenarioError, "--after: 20 s .*10.0 s"):
            what_if.read("flight.mcap", [{"fact": "flight", "end": 10e9}], radio)

    def test_the_share_that_went_out_and_the_share_that_arrived_are_told_apart(self):
        (row,), _ = what_if.rows(self.flown(), 0)
        self.assertEqual((row.posted, row.went_out, row.due, row.arrived), (90, 45, 45, 45))
        (late,), _ = what_if.rows(self.flown(), 5)
        self.assertEqual((late.posted, late.went_out, late.arrived), (50, 25, 25))

    def test_values_are_counted_up_to_a_time(self):
        (row,), _ = what_if.rows(self.flown(), 5, 8)
        self.assertEqual((row.posted, row.arrived), (30, 15))

    def test_counting_up_to_a_time_before_the_first_one_is_refused(self):
        radio = dataclasses.replace(self.RADIO, after=5, before=5)
        with self.assertRaisesRegex(ScenarioError, "--before: 5 s .*5 s of --after"):
            what_if.read("flight.mcap", [{"fact": "flight", "end": 10e9}], radio)

    def test_ages_begin_with_the_first_post_and_are_compared_to_those_of_the_recording(self):
        (row,), _ = what_if.rows(self.flown(), 0)
        self.assertAlmostEqual(row.delay_p90, 0.1)
        self.assertAlmostEqual(row.p50, 0.2, 1)
        self.assertAlmostEqual(row.recorded_p90, 0.09, 2)
        self.assertLess(row.worst, 0.35)

    def test_the_report_shows_messages_queues_and_limits(self):
        queue = {"fact": "queue", "from": "<b>", "to": "uav", "queue": "Q", "sent": 2, "refused": 1, "ages": [2e8],
                 "outcomes": {"delivered": 1, "expired": 1}}
        with contextlib.redirect_stdout(io.StringIO()) as said:
            what_if.show(self.flown([queue]), self.RADIO, self.folder)
        self.assertIn("50.0 % used; queues dropped 10.0 % of the frames", said.getvalue())
        self.assertIn("1 expired", said.getvalue())
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("uav/Q", text)
        self.assertNotIn("<b>", text)

    def test_an_option_without_its_unit_is_refused(self):
        with self.assertRaisesRegex(ScenarioError, "--radio: `57600`"):
            what_if.Radio.of(main.parse(["replay", "flight.mcap", "--radio", "57600"]))

    def test_an_option_that_cannot_be_flown_is_refused_in_one_line_that_names_it(self):
        for name, value in (("seed", "1.7"), ("seed", "-1"), ("seed", str(2 ** 64)), ("burst", "-3"), ("burst", "0.5"),
                            ("radio", "7bit/s"), ("jitter", "30ms"), ("delay", "2h")):
            with self.subTest(f"{name} {value}"):
                with self.assertRaisesRegex(ScenarioError, f"^--{name}: [^\n]*$"):
                    what_if.Radio.of(main.parse(["replay", "flight.mcap", "--delay", "20ms", f"--{name}", value]))

    def test_a_seed_is_passed_on_with_all_its_digits(self):
        words = what_if.Radio.of(main.parse(["replay", "flight.mcap", "--seed", str(2 ** 64 - 1)])).argv()
        self.assertEqual(words[words.index("--seed") + 1], str(2 ** 64 - 1))


class ReplayCommandTest(InFolder):
    def replay(self, fly):
        """(exit code, what it said)"""
        found = types.SimpleNamespace(replay="lab_replay")
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(said), \
                mock.patch.object(tools, "find", return_value=found), mock.patch.object(what_if, "fly", side_effect=fly):
            return main.main(["replay", "flight.mcap", "--to", str(self.folder / "results")]), said.getvalue()

    def test_a_folder_that_is_in_use_is_refused_before_the_flight(self):
        (self.folder / "results").mkdir()
        (self.folder / "results" / "mine").write_text("", encoding="utf-8")
        code, said = self.replay(AssertionError("it was flown"))
        self.assertEqual((code, "--to" in said), (2, True))

    def test_a_folder_that_cannot_be_made_is_refused_in_one_line(self):
        (self.folder / "results").write_text("", encoding="utf-8")
        code, said = self.replay(AssertionError("it was flown"))
        self.assertEqual((code, said.count("\n"), "--to" in said), (2, 1, True))

    def test_an_interrupted_flight_leaves_no_folder(self):
        code, said = self.replay(KeyboardInterrupt())
        self.assertEqual((code, said), (130, "interrupted\n"))
        self.assertFalse((self.folder / "results").exists())

    def test_a_recording_that_is_refused_leaves_no_folder(self):
        self.assertEqual(self.replay(ScenarioError("flight.mcap", "is no recording"))[0], 2)
        self.assertFalse((self.folder / "results").exists())


class PlacesTest(InFolder):
    RANGE = scenario.Range("Pose", 800.0, "free-space", [], {"ground": [47.0, 8.0, 0.0]}, 1)

    def test_half_is_lost_at_the_distance_that_is_named(self):
        self.assertAlmostEqual(places.loss_at(800, self.RANGE), 50)
        self.assertLess(places.loss_at(400, self.RANGE), 1.1)
        self.assertGreater(places.loss_at(1600, self.RANGE), 98.9)

    def test_a_position_changes_the_loss_of_both_directions_once(self):
        place = places.Places(scenario.Network("radio", ["uav1", "ground"], range=self.RANGE), self.folder)
        place.take("uav1", {"latitude_deg": 47.0, "longitude_deg": 8.02, "altitude_m": 0.0})  # 1517 m
        changed = {(one, other) for one, other, percent, _ in place.changes(0.0) if percent > 98}
        self.assertEqual(changed, {("uav1", "ground"), ("ground", "uav1")})
        self.assertEqual(place.changes(0.5), [])
        self.assertGreater(place.loss("uav1", "ground", 5.0), 98)  # after an event, too
        self.assertEqual(place.loss("uav1", "uav2", 5.0), 5.0)

    def test_a_track_is_followed_between_its_points(self):
        (self.folder / "track.csv").write_text("time_s,node,x,y,z\n0,uav1,0,0,0\n10,uav1,100,0,0\n", encoding="utf-8")
        self.assertEqual(places.Track(self.folder / "track.csv").at(5), {"uav1": (50, 0, 0)})
        (self.folder / "track.csv").write_text("time_s,node,x,y,z\n0,uav1,0,0,there\n", encoding="utf-8")
        with self.assertRaisesRegex(ValueError, "track.csv:2"):
            places.Track(self.folder / "track.csv")


class ResultsTest(InFolder):
    def test_report_and_junit_show_a_failure_and_escape_what_nodes_say(self):
        read = self.read("expect:\n  - all up within 3s\n")
        made = Made(read)
        made.flight.output.append((1.0, "uav1", "<script>alert(1)</script>\x01"))
        verdicts = [expect.verdict(made.flight) for expect in read.expects]
        (self.folder / "scenario.yaml").write_text("x", encoding="utf-8")
        junit.write(read, verdicts, made.flight, False, self.folder / "junit.xml")
        report.write(read, made.flight, verdicts, False, "", self.folder)
        suite = ElementTree.parse(self.folder / "junit.xml").getroot()
        self.assertEqual(suite.get("failures"), "1")
        self.assertIn("uav1 saw uav2 UP never", suite.find("testcase/failure").get("message"))
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("not met", text)
        self.assertNotIn("<script>alert", text)

    def test_the_states_that_the_others_saw_are_shown_by_their_shares(self):
        made = Made(self.read()).all_up(1)
        made.sees("ground", "uav1", 10, "LOST")
        made.sees("ground", "uav1", 12, "UP")
        self.assertEqual(plots.seen_states(made.flight, "uav1"),
                         [(0.0, 1, [("", 1)]), (1, 10, [("UP", 2)]), (10, 12, [("UP", 1), ("LOST", 1)]), (12, 30.0, [("UP", 2)])])

    def test_a_node_is_lost_in_the_line_only_if_most_of_the_others_have_lost_it(self):
        made = Made(self.read()).all_up(1)
        for node in ("uav1", "uav2"):
            made.sees("ground", node, 10, "LOST")
            made.sees(node, "ground", 10, "LOST")
        text = table.Table(made.flight.scenario, made.flight, io.StringIO()).summary(11)
        self.assertEqual(text, "3 of 3 nodes run; LOST: ground; 2 more at half of the others or fewer")

    def test_a_new_scenario_names_the_nodes_of_a_folder_and_is_right(self):
        (self.folder / "station").write_text("", encoding="utf-8")
        (self.folder / "station").chmod(0o755)
        (self.folder / "station.yaml").write_text("node: station\npublish:\n  - {message: Wind, type: W}\n", encoding="utf-8")
        (self.folder / "sh").symlink_to("/bin/sh")
        (self.folder / "sh.yaml").write_text("node: show\nsecurity: {keys: /etc/keys}\nsubscribe:\n  - {message: Wind, type: W}\n", encoding="utf-8")
        new.write(self.folder, None)
        read = scenario.read(self.folder / "scenario.yaml")
        self.assertEqual({name: node.keys for name, node in read.nodes.items()},
                         {"show": str(self.folder.resolve() / "sh.yaml"), "station": ""})
        self.assertIn("station/Wind at show: age p90 < 2s, before 20s", [expect.text for expect in read.expects])


class UnitsTest(unittest.TestCase):
    def test_quantities_without_their_unit_are_refused(self):
        self.assertEqual(units.seconds("-10min"), -600)
        for unit, text in ((units.bits_per_second, "250"), (units.percent, "10"), (units.length, "-3s"), (units.size, "4 apples")):
            with self.assertRaises(ValueError):
                unit(text)


if __name__ == "__main__":
    unittest.main()
