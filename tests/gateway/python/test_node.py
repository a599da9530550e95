"""Promises of a node beside the exchange itself."""

import asyncio
import logging
import signal
import textwrap
import threading

import pytest

import rabit
from conftest import program, run, wait_until


def test_a_wrong_configuration_is_one_line_of_the_gateway(idl, tmp_path):
    with pytest.raises(rabit.ConfigError, match="unknown key `domin`.*did you mean `domain`"):
        rabit.Node("planner", domin=7)
    with pytest.raises(rabit.ConfigError, match="domain"):
        rabit.Node("planner", domain=1000)
    with pytest.raises(rabit.ConfigError, match="Uav::Poze.*did you mean `Uav::Pose`"):
        rabit.Node("planner", publish={"Pose": "Uav::Poze"})
    file = tmp_path / "planner.yaml"
    file.write_text("node: planner\ntransprt: fastdds\n")
    with pytest.raises(rabit.ConfigError, match=r"planner.yaml:2: .*did you mean `transport`"):
        rabit.Node(config=file)
    with pytest.raises(rabit.ConfigError, match="fastdds"):
        rabit.Node("planner", transport="fasdds").start()


def test_a_file_and_settings_of_the_program_make_one_configuration(idl, tmp_path, one_network):
    file = tmp_path / "planner.yaml"
    file.write_text("node: planner\ndomain: 3\npublish:\n  - {message: Pose, type: Uav::Pose}\n")
    with rabit.Node(config=file, accept={"Commands": [idl.Uav.Goto]}, **one_network) as node:
        assert node.name == "planner"
        node.post("Pose", idl.Uav.Pose())
        assert len(node.queue("Commands")) == 0


def test_wrong_use_names_what_is_wrong(idl, one_network):
    node = rabit.Node("planner", publish={"Pose": idl.Uav.Pose}, accept={"Commands": [idl.Uav.Goto]}, **one_network)
    with pytest.raises(RuntimeError, match="does not run yet"):
        node.subscribe("Pose", idl.Uav.Pose)
    with node:
        with pytest.raises(KeyError, match="accepts no queue `Comands`; did you mean `Commands`"):
            node.queue("Comands")
        with pytest.raises(TypeError, match="post Pose: the message is of another type than Uav::Goto"):
            node.post("Pose", idl.Uav.Goto())
        with pytest.raises(TypeError, match="expected a message, not 5"):
            node.post("Pose", 5)
        with pytest.raises(TypeError, match="expected the class of an IDL message"):
            node.subscribe("uav1/Pose", int)
        with pytest.raises(ValueError, match="no node name or pattern"):
            node.subscribe("u v/Pose", idl.Uav.Pose)
        receipt = node.send("nobody/Commands", idl.Uav.Goto())
        assert receipt.wait(1) is rabit.Outcome.REFUSED and "nobody" in receipt.reason
        assert node.send("Nowhere", idl.Uav.Goto()).reason == "there is no queue `Nowhere`"
        assert node.send("planner/Comands", idl.Uav.Goto()).reason == "there is no queue `Comands`"
        with pytest.raises(TimeoutError):
            node.queue("Commands").get(timeout=0.01)
    with pytest.raises(RuntimeError, match="was stopped"):
        node.post("Pose", idl.Uav.Pose())


class WakesOnPose(rabit.Manager):
    def __init__(self, cls):
        self.wake_on = {"Pose": cls}


def test_a_name_has_one_type(idl, one_network):
    another = "the local message `Pose` is of another type than Uav::Goto"
    with pytest.raises(TypeError, match=another):
        rabit.Node("planner", publish={"Pose": idl.Uav.Pose}, managers=[WakesOnPose(idl.Uav.Goto)], **one_network)
    foreign = [{"publish": "Pose", "topic": "pose", "type": idl.Uav.Pose}]
    with pytest.raises(TypeError, match=another):
        rabit.Node("planner", foreign=foreign, managers=[WakesOnPose(idl.Uav.Goto)], **one_network)
    with rabit.Node("planner", managers=[WakesOnPose(idl.Uav.Pose)], **one_network) as node:
        with pytest.raises(TypeError, match="post Pose: the message is of another type than Uav::Goto"):
            node.post("Pose", idl.Uav.Goto())
        with pytest.raises(TypeError, match=another):
            node.subscribe("Pose", idl.Uav.Goto)
        poses = node.subscribe("Pose", idl.Uav.Pose)
        node.post("Pose", idl.Uav.Pose(number=1))
        assert poses.get(timeout=120).value.number == 1


def test_a_slow_reader_gets_the_newest_value(idl, one_network):
    with rabit.Node("planner", **one_network) as node:
        poses = node.subscribe("Pose", idl.Uav.Pose)
        for number in range(1, 101):
            node.post("Pose", idl.Uav.Pose(number=number))
        assert poses.get(timeout=120).value.number == 100
        assert poses.latest()[""].value.number == 100
        with pytest.raises(TimeoutError):
            poses.get(timeout=0.05)


def test_a_slow_handler_gets_the_newest_value(idl, one_network):
    begun, may_end, seen = threading.Event(), threading.Event(), []
    with rabit.Node("planner", **one_network) as node:

        @node.subscribe("Pose", idl.Uav.Pose).on
        def handle(pose):
            seen.append(pose.value.number)
            begun.set()
            assert may_end.wait(120)

        node.post("Pose", idl.Uav.Pose(number=1))
        assert begun.wait(120)
        for number in range(2, 101):
            node.post("Pose", idl.Uav.Pose(number=number))
        may_end.set()
        wait_until(lambda: seen[-1] == 100)
        assert seen == [1, 100]


def test_the_budget_of_a_radio_is_in_the_fleet(one_network):
    with rabit.Node("uav1", radio={"budget": "5kB/s"}, **one_network) as node:
        wait_until(lambda: node.fleet().value.air.budget == 5000)


def test_a_second_subscription_of_a_message_adds_its_nodes(idl, one_network):
    uavs = [rabit.Node(name, publish={"Pose": idl.Uav.Pose}, **one_network) for name in ("uav1", "uav2")]
    with uavs[0], uavs[1], rabit.Node("ground", **one_network) as ground:
        first = ground.subscribe("uav1/Pose", idl.Uav.Pose)
        uavs[0].post("Pose", idl.Uav.Pose(number=1))
        assert first.get(timeout=120).value.number == 1
        second = ground.subscribe("uav2/Pose", idl.Uav.Pose)
        uavs[1].post("Pose", idl.Uav.Pose(number=2))
        assert second.get(timeout=120).value.number == 2
        uavs[0].post("Pose", idl.Uav.Pose(number=3))
        # A State that was there comes once more when nodes are added.
        wait_until(lambda: first.get(timeout=120).value.number == 3)


def test_a_command_that_nobody_takes_expires(idl, one_network):
    with rabit.Node("ground", **one_network) as ground:
        uav = rabit.Node("uav1", accept={"MissionControl": [idl.Uav.Goto]}, **one_network)
        with uav:
            wait_until(lambda: ground.send("uav1/MissionControl", idl.Uav.Goto(), expire=0.5).outcome
                       is not rabit.Outcome.REFUSED)
        receipt = ground.send("uav1/MissionControl", idl.Uav.Goto(), expire=0.5)
        assert receipt.wait(120) in (rabit.Outcome.EXPIRED, rabit.Outcome.IN_DOUBT)
        with pytest.raises(ValueError, match="live equally long"):
            ground.send("uav1/MissionControl", idl.Uav.Goto(), expire=5)
        with pytest.raises(ValueError, match="expire"):
            ground.send("uav2/MissionControl", idl.Uav.Goto(), expire=-1)


def test_a_message_to_all_has_an_outcome_for_each(idl, one_network):
    accept = {"MissionControl": [idl.Uav.Goto]}
    uavs = [rabit.Node(name, accept=accept, **one_network) for name in ("uav1", "uav2")]
    with uavs[0], uavs[1], rabit.Node("ground", **one_network) as ground:
        wait_until(lambda: all(ground.fleet().is_up(name) for name in ("uav1", "uav2")))
        receipt = wait_until(lambda: (lambda r: r if r.counts[rabit.Outcome.REFUSED] == 0 and sum(r.counts.values()) == 2 else None)(
            ground.send("*/MissionControl", idl.Uav.Goto(id=1))))
        assert receipt.wait(120) is rabit.Outcome.DELIVERED
        assert receipt.counts[rabit.Outcome.DELIVERED] == 2
        fleet = ground.fleet()
        assert sorted(fleet) == ["uav1", "uav2"] and fleet["uav1"].state.name == "UP" and len(fleet) == 2


def test_a_handler_that_raises_is_logged_and_the_next_value_is_handled(idl, one_network, caplog):
    handled = []
    with rabit.Node("planner", **one_network) as node:
        poses = node.subscribe("Pose", idl.Uav.Pose)

        @poses.on
        def handle(pose):
            handled.append(pose.value.number)
            raise ValueError("a mistake")

        with caplog.at_level(logging.ERROR, logger="rabit"):
            for number in (1, 2):
                node.post("Pose", idl.Uav.Pose(number=number))
                wait_until(lambda: number in handled)
    assert "a mistake" in caplog.text and "Traceback" in caplog.text and "handler of Pose" in caplog.text


class Counter(rabit.Manager):
    period = 0.01

    def __init__(self, goto):
        self.wake_on = {"Order": goto}
        self.calls = []
        self.raises = False

    def startup(self):
        self.calls.append("startup")

    def unit_of_work(self):
        self.calls.append("unit" if self.is_turn else "woken")
        if self.raises:
            self.raises = False
            raise RuntimeError("a mistake in a manager")

    def shutdown(self):
        self.calls.append("shutdown")


def test_a_manager_runs_with_its_period_and_is_woken(idl, one_network, caplog):
    manager = Counter(idl.Uav.Goto)
    with rabit.Node("planner", managers=[manager], **one_network) as node:
        wait_until(lambda: manager.calls.count("unit") > 3)
        # A wake-up at the moment of a turn is part of it.
        wait_until(lambda: (node.post("Order", idl.Uav.Goto()), "woken" in manager.calls)[1])
        with caplog.at_level(logging.ERROR, logger="rabit"):
            manager.raises = True
            wait_until(lambda: not manager.raises)
            count = len(manager.calls)
            wait_until(lambda: len(manager.calls) > count + 2)
    assert manager.calls[0] == "startup" and manager.calls[-1] == "shutdown"
    assert "a mistake in a manager" in caplog.text and "manager Counter: unit_of_work" in caplog.text


class Troubled(rabit.Manager):
    period = 0.1

    def __init__(self, work):
        self.work = work

    def unit_of_work(self):
        self.work()


def rows(node, subject):
    return [problem.reason for problem in node.fleet().problems if problem.subject == subject]


def test_a_manager_that_hangs_is_a_problem_until_it_goes_on(one_network):
    release = threading.Event()
    with rabit.Node("planner", managers=[Troubled(release.wait)], **one_network) as node:
        try:
            found = wait_until(lambda: rows(node, "manager Troubled"))
        finally:
            release.set()
        assert "its unit of work has not returned for more than 1.0 s" in found[0]
        wait_until(lambda: not rows(node, "manager Troubled"))


def test_a_manager_that_raises_at_each_turn_is_a_problem(one_network):
    with rabit.Node("planner", managers=[Troubled(lambda: 1 / 0)], **one_network) as node:
        wait_until(lambda: rows(node, "manager Troubled"))
        assert rows(node, "manager Troubled") == ["its unit of work threw: ZeroDivisionError: division by zero"]


def test_beats_go_on_while_python_computes(idl, one_network):
    """A regular expression that backtracks holds the GIL, and does so for years."""
    program = textwrap.dedent(f"""
        import re, sys, rabit
        node = rabit.Node("uav1", **{one_network!r})
        with node:
            print("up", flush=True)
            sys.stdin.readline()
            print("computes", flush=True)
            re.match("(a*)*b", "a" * 100)
    """)
    with rabit.Node("ground", **one_network) as ground, run(program) as child:
        assert child.stdout.readline() == "up\n"
        wait_until(lambda: ground.fleet().is_up("uav1"), 120)
        child.stdin.write("go\n")
        child.stdin.flush()
        assert child.stdout.readline() == "computes\n"
        with rabit.Node("late", **one_network) as late:
            wait_until(lambda: late.fleet().is_up("uav1"))  # by beats that were sent since
        assert child.poll() is None
        child.kill()


@pytest.mark.parametrize(
    "text",
    [
        """
        with rabit.Node("planner", **network) as node:
            for pose in node.subscribe("uav*/Pose", idl.Uav.Pose):
                print("heard", flush=True)
        """,
        """
        async def main():
            async with rabit.Node("planner", **network) as node:
                async for pose in node.subscribe("uav*/Pose", idl.Uav.Pose):
                    print("heard", flush=True)
        asyncio.run(main())
        """,
    ],
    ids=["thread", "loop"],
)
def test_ctrl_c_ends_a_program_that_waits(idl, one_network, text):
    uav = rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, **one_network)
    with uav, run(program(one_network, text)) as child:
        uav.post("Pose", idl.Uav.Pose())
        assert child.stdout.readline() == "heard\n"
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=120)
        assert child.returncode == -signal.SIGINT and errors.strip().endswith("KeyboardInterrupt")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_may_stop_the_node(one_network, number):
    text = """
        node = rabit.Node("planner", **network)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: node.stop())
        with node:
            poses = node.subscribe("uav*/Pose", idl.Uav.Pose)
            print("ready", flush=True)
            for pose in poses:
                pass
        print("ended")
        """
    with run(program(one_network, text)) as child:
        assert child.stdout.readline() == "ready\n"
        child.send_signal(number)
        out, errors = child.communicate(timeout=240)
        assert (child.returncode, out, errors) == (0, "ended\n", "")


@pytest.mark.parametrize(
    "text",
    [
        "node = rabit.Node('planner', **network); node.start()",
        "node = rabit.Node('planner', **network); node.start(); node.subscribe('Pose', idl.Uav.Pose).on(print)",
        "node = rabit.Node('planner', **network); node.start(); del node",
        "node = rabit.Node('planner', **network); node.start(); raise SystemExit(0)",
        """
        class Planner(rabit.Manager):
            period = 0.001
            def unit_of_work(self): self.post('Pose', idl.Uav.Pose()); works.set()
        works = threading.Event()
        node = rabit.Node('planner', managers=[Planner()], **network); node.start(); works.wait()
        """,
        "threading.Thread(target=lambda: rabit.Node('planner', **network).start()).start()",
    ],
)
def test_the_interpreter_ends_with_nodes_that_run(one_network, text):
    with run(program(one_network, text)) as child:
        _, errors = child.communicate(timeout=240)
        assert child.returncode == 0, errors
        assert "Traceback" not in errors


def test_a_forked_process_leaves_the_node_alone_and_starts_none(one_network):
    text = """
        node = rabit.Node("planner", **network)
        node.start()

        def refused(call, words):
            try:
                call()
            except RuntimeError as error:
                assert words in str(error), error
            else:
                raise AssertionError("not refused")

        def child():
            refused(lambda: node.post("Pose", idl.Uav.Pose()), "forked process")
            node.stop()
            refused(rabit.Node("other", **network).start, "was forked while nodes ran")

        forked(child)()
        assert node.is_running and node.flush(120)
        node.stop()
        """
    with run(program(one_network, text)) as child:
        _, errors = child.communicate(timeout=240)
        assert child.returncode == 0, errors


def test_a_process_that_was_forked_without_nodes_may_have_its_own(one_network):
    text = """
        def use_a_node():
            with rabit.Node("other", **network) as own:
                own.post("Pose", idl.Uav.Pose())
                assert own.flush(120)

        with rabit.Node("planner", **network) as node:
            pass
        wait = forked(use_a_node)
        use_a_node()
        wait()
        """
    with run(program(one_network, text)) as child:
        _, errors = child.communicate(timeout=240)
        assert child.returncode == 0, errors


def test_a_process_that_was_forked_after_a_start_that_failed_may_have_its_own_nodes(one_network):
    text = """
        def use_a_node():
            with rabit.Node("other", **network) as own:
                assert own.flush(120)

        wrong = rabit.Node("planner", **{**network, "transport": "none"})
        try:
            wrong.start()
        except rabit.ConfigError:
            forked(use_a_node)()
        else:
            raise AssertionError("not refused")
        """
    with run(program(one_network, text)) as child:
        _, errors = child.communicate(timeout=240)
        assert child.returncode == 0, errors


@pytest.mark.skipif("cyclonedds" not in rabit.transports(), reason="the file is one of Cyclone DDS")
def test_a_node_that_is_started_again_after_a_wrong_configuration_records_once(idl, one_network, tmp_path):
    file = tmp_path / "cyclone.xml"
    node = rabit.Node("planner", publish={"Pose": idl.Uav.Pose}, record={"folder": str(tmp_path / "flights")},
                      backend_config=str(file), **{**one_network, "transport": "cyclonedds"})
    for _ in range(2):
        with pytest.raises(rabit.ConfigError, match="cyclone.xml"):
            node.start()
    file.write_text("<CycloneDDS/>")
    with node:
        node.post("Pose", idl.Uav.Pose(number=1))
        assert node.flush(120)
    recordings = list((tmp_path / "flights").glob("*.mcap"))
    assert len(recordings) == 1
    assert [message.value.number for message in rabit.open(*recordings).messages("planner/Pose")] == [1]


def test_a_time_that_is_no_number_is_refused(idl, one_network):
    nan = float("nan")
    with rabit.Node("planner", publish={"Pose": idl.Uav.Pose}, accept={"Commands": [idl.Uav.Goto]}, **one_network) as node:
        for wait in (lambda: node.queue("Commands").get(timeout=nan), lambda: node.flush(nan)):
            with pytest.raises(ValueError, match="expected a number of seconds, not nan"):
                wait()


def test_a_wait_without_end_ends_when_it_may(idl, one_network):
    forever = float("inf")
    with rabit.Node("planner", publish={"Pose": idl.Uav.Pose}, accept={"Commands": [idl.Uav.Goto]}, **one_network) as node:
        node.post("Pose", idl.Uav.Pose(number=1))
        assert node.flush(forever)
        node.send("Commands", idl.Uav.Goto(id=7))
        assert node.queue("Commands").get(timeout=forever).value.id == 7


def test_iterations_end_when_the_node_stops(idl, one_network):
    taken, ended = [], []

    def read(stream):
        for one in stream:
            taken.append(one)
        ended.append(stream)

    node = rabit.Node("planner", publish={"Pose": idl.Uav.Pose}, accept={"Commands": [idl.Uav.Goto]}, **one_network)
    node.start()
    threads = [threading.Thread(target=read, args=[stream])
               for stream in (node.subscribe("Pose", idl.Uav.Pose), node.queue("Commands"))]
    for thread in threads:
        thread.start()
    node.post("Pose", idl.Uav.Pose())
    node.send("Commands", idl.Uav.Goto())
    wait_until(lambda: len(taken) == 2)
    node.stop()
    for thread in threads:
        thread.join(120)
    assert len(ended) == 2


def test_a_cancelled_wait_leaves_the_loop_in_order(idl, one_network):
    async def main():
        async with rabit.Node("planner", **one_network) as node:
            poses = node.subscribe("Pose", idl.Uav.Pose)
            with pytest.raises(asyncio.TimeoutError):
                await asyncio.wait_for(anext(poses), 0.05)
            node.post("Pose", idl.Uav.Pose(number=3))
            assert (await asyncio.wait_for(anext(poses), 120)).value.number == 3

    asyncio.run(main())
