"""A node ends while other threads and its managers use it."""

import logging
import os
import select
import threading

import pytest

import rabit
from conftest import program, run


def end_of(network, text, **more):
    """Returns the output of the program, which ends within a minute."""
    with run(program(network, text), **more) as child:
        try:
            out, errors = child.communicate(timeout=240)
        except BaseException:
            child.kill()
            raise
        assert child.returncode == 0, errors
        assert "Traceback" not in errors
        return out


@pytest.mark.parametrize(
    "call",
    ["node.flush(3600)", "node.send('uav1/Commands', idl.Uav.Goto())", "node.post('Pose', idl.Uav.Pose())",
     "node.subscribe('uav*/Pose', idl.Uav.Pose).latest()"],
    ids=["flush", "send", "post", "subscribe"],
)
def test_a_node_ends_beside_threads_that_use_it(one_network, call):
    """A flush that no unit of work answers any more ends, too."""
    out = end_of(one_network, f"""
        def use(node):
            try:
                while True:
                    {call}
            except RuntimeError as error:
                assert "was stopped" in str(error), error

        for _ in range(4):
            node = rabit.Node("planner", **network)
            node.start()
            threads = [threading.Thread(target=use, args=[node]) for _ in range(3)]
            for thread in threads:
                thread.start()
            time.sleep(0.1)
            node.stop()
            for thread in threads:
                thread.join()
        print("ended")
        """)
    assert out == "ended\n"


def test_a_manager_that_stops_its_node_ends_the_iterations(one_network):
    out = end_of(one_network, """
        class Once(rabit.Manager):
            period = 0.01
            def unit_of_work(self):
                self.node.stop()
            def shutdown(self):
                print("shutdown", flush=True)

        with rabit.Node("planner", managers=[Once()], **network) as node:
            for pose in node.subscribe("uav*/Pose", idl.Uav.Pose):
                pass
            assert not node.is_running
        print("ended")
        """)
    assert out == "shutdown\nended\n"


def test_threads_and_an_event_loop_that_wait_for_one_stream_all_hear_of_its_end(idl, one_network):
    node = rabit.Node("planner", accept={"Commands": [idl.Uav.Goto]}, **one_network)
    with node:
        cores = [node.subscribe("Pose", idl.Uav.Pose)._core, node.queue("Commands")._core]
        for core in cores:
            core.arm()
    for core in cores:
        core.drain()
        assert select.select([core.fd], [], [], 0)[0]


def test_a_manager_may_stop_its_node_before_start_returns(one_network):
    out = end_of(one_network, """
        stopped = threading.Event()

        class Once(rabit.Manager):
            def unit_of_work(self):
                self.node.stop()
                stopped.set()

        class Late:
            def __init__(self, core):
                self._core = core
            def __getattr__(self, name):
                return getattr(self._core, name)
            def start(self):
                self._core.start()
                assert stopped.wait(120)

        node = rabit.Node("planner", managers=[Once()], **network)
        node._core = Late(node._core)
        with node:
            assert not node.is_running
            for pose in node.subscribe("uav*/Pose", idl.Uav.Pose):
                pass
        print("ended")
        """)
    assert out == "ended\n"


@pytest.mark.skipif("RABIT_REFUSED" not in os.environ, reason="RABIT_REFUSED is not set")
def test_a_node_whose_start_gets_a_thread_too_few_is_started_later(one_network):
    """RABIT_REFUSED: a library that refuses the last thread that the start makes."""
    out = end_of(one_network, """
        import ctypes
        library, many = ctypes.CDLL(None), 1000
        other = rabit.Node("planner", **network)
        library.refuse_thread(many)
        other.start()
        threads = many - library.refuse_thread(0)
        other.stop()

        node = rabit.Node("planner", **network)
        library.refuse_thread(threads)
        try:
            node.start()
        except RuntimeError as error:
            print(error)
        assert not node.is_running
        with node:
            assert node.flush(120)
        """, env={**os.environ, "LD_PRELOAD": os.environ["RABIT_REFUSED"]})
    assert out == "Resource temporarily unavailable\n"


def test_a_node_ends_whose_handler_got_no_thread(idl, one_network, monkeypatch):
    with rabit.Node("planner", **one_network) as node:
        poses = node.subscribe("Pose", idl.Uav.Pose)
        with monkeypatch.context() as patch, pytest.raises(RuntimeError, match="no thread"):
            def refuse(thread):
                raise RuntimeError("no thread")

            patch.setattr(threading.Thread, "start", refuse)
            poses.on(print)
        heard = threading.Event()
        poses.on(lambda pose: heard.set())
        node.post("Pose", idl.Uav.Pose())
        assert heard.wait(120)


def test_handlers_that_stop_their_node_do_not_wait_for_each_other(one_network):
    out = end_of(one_network, """
        both = threading.Barrier(2)

        def handle(value):
            both.wait()
            node.stop()

        with rabit.Node("planner", **network) as node:
            threads = set(threading.enumerate())
            for name in ("Pose", "Order"):
                node.subscribe(name, idl.Uav.Pose).on(handle)
            handlers = set(threading.enumerate()) - threads
            for name in ("Pose", "Order"):
                node.post(name, idl.Uav.Pose())
            for thread in handlers:
                thread.join()
        print("ended")
        """)
    assert out == "ended\n"


def test_ctrl_c_ends_the_wait_for_a_manager_that_does_not_end(one_network):
    out = end_of(one_network, """
        class Endless(rabit.Manager):
            def unit_of_work(self):
                works.set()
                goes_on.wait()

        works, goes_on = threading.Event(), threading.Event()
        node = rabit.Node("planner", managers=[Endless()], **network)
        node.start()
        works.wait()
        threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT]).start()
        try:
            node.stop()
        except KeyboardInterrupt:
            print("interrupted")
        goes_on.set()
        node.stop()
        print("ended")
        """)
    assert out == "interrupted\nended\n"


class Talker(rabit.Manager):
    """Uses its node until it has ended."""

    def __init__(self, idl):
        self.idl = idl
        self.has_ended = False

    def unit_of_work(self):
        pass

    def shutdown(self):
        self.post("Pose", self.idl.Uav.Pose())
        self.send("nobody/Commands", self.idl.Uav.Goto())
        with pytest.raises(RuntimeError, match="was stopped"):
            self.node.subscribe("uav*/Pose", self.idl.Uav.Pose).get(timeout=120)
        self.has_ended = True


def test_a_manager_uses_its_node_while_it_ends(idl, one_network, caplog):
    manager = Talker(idl)
    with caplog.at_level(logging.ERROR, logger="rabit"), rabit.Node("planner", managers=[manager], **one_network):
        assert manager.is_turn
    assert caplog.text == "" and manager.has_ended


def test_a_manager_has_no_turn_after_its_node(idl, one_network):
    manager = Talker(idl)
    with rabit.Node("planner", managers=[manager], **one_network):
        pass
    manager.wake()
    assert not manager.is_turn


def test_a_value_may_stop_the_node_that_is_to_post_it(idl, one_network):
    class Last:
        def __index__(self):
            node.stop()
            return 1

    node = rabit.Node("planner", **one_network)
    node.start()
    node.post("Pose", idl.Uav.Pose())
    with pytest.raises(RuntimeError, match="was stopped"):
        node.post("Pose", idl.Uav.Pose(number=Last()))
