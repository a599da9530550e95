"""An event loop waits for outcomes and streams."""

import asyncio
import contextlib
import gc
import os
import select

import pytest

import rabit
from conftest import wait_until


async def outcome_of(receipt):
    return await receipt


@contextlib.asynccontextmanager
async def pending_receipts(idl, network, count):
    """A node, the queue of another with room for one message, and receipts of messages that wait for room there. Each
    `get` from the queue makes the next outcome known."""
    uav = rabit.Node("uav1", accept={"Commands": [idl.Uav.Goto]}, queue_capacity=1, **network)
    async with uav, rabit.Node("ground", **network) as ground:
        while (await ground.send("uav1/Commands", idl.Uav.Goto())) is rabit.Outcome.REFUSED:
            await asyncio.sleep(0.01)
        receipts = [ground.send("uav1/Commands", idl.Uav.Goto(id=i)) for i in range(count)]
        yield ground, uav.queue("Commands"), receipts


class Interrupted:
    """The node's side of an event loop's outcomes. Whenever the loop has called it, one more outcome becomes known."""

    def __init__(self, core, queue, receipts):
        self._core = core
        self._queue = queue
        self._receipts = list(receipts)

    def __getattr__(self, name):
        return getattr(self._core, name)

    def next(self):
        if self._receipts:
            self._queue.get(timeout=120)
            receipt = self._receipts.pop(0)
            wait_until(lambda: receipt.done)

    def arm_outcomes(self):
        self._core.arm_outcomes()
        self.next()

    def take_outcomes(self):
        known = self._core.take_outcomes()
        self.next()
        return known


def test_an_outcome_that_becomes_known_while_others_are_taken_wakes_the_loop(idl, one_network):
    async def main():
        async with pending_receipts(idl, one_network, 8) as (ground, queue, receipts):
            tasks = [asyncio.create_task(outcome_of(receipt)) for receipt in receipts]
            await asyncio.sleep(0)
            assert not any(receipt.done for receipt in receipts)
            ground._outcomes._core = Interrupted(ground._core, queue, receipts)
            ground._outcomes._core.next()
            assert set(await asyncio.wait_for(asyncio.gather(*tasks), 120)) == {rabit.Outcome.DELIVERED}

    asyncio.run(main())


def test_hundreds_of_outcomes_are_awaited_at_once(idl, one_network):
    async def main():
        async with pending_receipts(idl, one_network, 300) as (ground, queue, receipts):
            tasks = [asyncio.create_task(outcome_of(receipt)) for receipt in receipts]
            await asyncio.sleep(0)
            queue.on(lambda command: None)
            assert set(await asyncio.wait_for(asyncio.gather(*tasks), 240)) == {rabit.Outcome.DELIVERED}

    asyncio.run(main())


def test_one_outcome_is_awaited_twice(idl, one_network):
    async def main():
        async with pending_receipts(idl, one_network, 1) as (ground, queue, receipts):
            tasks = [asyncio.create_task(outcome_of(receipts[0])) for _ in range(2)]
            await asyncio.sleep(0)
            queue.get(timeout=120)
            assert await asyncio.wait_for(asyncio.gather(*tasks), 120) == [rabit.Outcome.DELIVERED] * 2

    asyncio.run(main())


def test_an_event_loop_keeps_no_stream_that_was_dropped(idl, one_network):
    async def main():
        async with rabit.Node("planner", **one_network) as node:
            async def read_one():
                poses = node.subscribe("Pose", idl.Uav.Pose)
                with pytest.raises(asyncio.TimeoutError):
                    await asyncio.wait_for(anext(poses), 0.01)

            await read_one()
            gc.collect()
            files = len(os.listdir("/proc/self/fd"))
            for _ in range(10):
                await read_one()
            gc.collect()
            assert len(os.listdir("/proc/self/fd")) <= files

    asyncio.run(main())


def test_a_stream_is_awaited_in_one_event_loop_after_the_other(idl, one_network):
    loops = asyncio.new_event_loop(), asyncio.new_event_loop()
    with rabit.Node("planner", **one_network) as node:
        poses = node.subscribe("Pose", idl.Uav.Pose)

        async def next_of(number):
            waiting = asyncio.ensure_future(anext(poses))
            await asyncio.sleep(0)
            node.post("Pose", idl.Uav.Pose(number=number))
            return (await asyncio.wait_for(waiting, 120)).value.number

        for number in range(1, 7):
            assert loops[number % 2].run_until_complete(next_of(number)) == number
    for loop in loops:
        loop.close()


def test_a_node_ends_while_all_threads_of_the_loop_wait_for_it(idl, one_network):
    async def main():
        async with rabit.Node("planner", **one_network) as node:
            loop = asyncio.get_running_loop()
            poses = node.subscribe("Pose", idl.Uav.Pose)
            waits = [loop.run_in_executor(None, poses.get) for _ in range(64)]
        ended = await asyncio.wait_for(asyncio.gather(*waits, return_exceptions=True), 120)
        assert all(isinstance(error, RuntimeError) for error in ended)

    asyncio.run(main())


def test_a_node_whose_start_is_cancelled_does_not_run(one_network):
    async def main():
        node = rabit.Node("planner", **one_network)
        starting = asyncio.create_task(node.__aenter__())
        await asyncio.sleep(0)
        starting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await starting
        assert not node.is_running
        with pytest.raises(RuntimeError, match="was stopped"):
            node.start()

    asyncio.run(main())


def test_a_node_that_stops_ends_the_waits_of_an_event_loop(idl, one_network):
    async def main():
        node = rabit.Node("planner", accept={"Commands": [idl.Uav.Goto]}, **one_network)
        node.start()

        async def read(stream):
            return [item async for item in stream]

        tasks = [asyncio.create_task(read(stream))
                 for stream in (node.subscribe("uav*/Pose", idl.Uav.Pose), node.queue("Commands"))]
        await asyncio.sleep(0)  # each begins to wait
        await asyncio.get_running_loop().run_in_executor(None, node.stop)
        assert await asyncio.wait_for(asyncio.gather(*tasks), 120) == [[], []]

    asyncio.run(main())


def test_a_thread_that_waits_leaves_the_event_loop_its_wake_up(idl, one_network):
    with rabit.Node("planner", accept={"Commands": [idl.Uav.Goto]}, **one_network) as node:
        core = node.queue("Commands")._core
        assert core.fd
        core.arm()
        node.send("Commands", idl.Uav.Goto())
        assert core.take()
        assert not core.wait(0.01)
        assert select.select([core.fd], [], [], 0)[0]
