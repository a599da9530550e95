"""Claims and the shared table."""

import asyncio
import contextlib
import json
import re
import threading

import pytest

import rabit
from conftest import ROOT, program, run, wait_until

ALONE = {"members": ["uav1"]}
THREE = {"members": ["ground", "uav1", "uav2"]}


def test_a_node_without_an_agreement_has_no_claims(one_network):
    node = rabit.Node("uav1", **one_network)
    for what in ("claims", "table"):
        with pytest.raises(rabit.ConfigError, match="need the section `agreement`"):
            getattr(node, what)


def test_an_agreement_of_the_program_replaces_that_of_the_file(one_network, tmp_path):
    file = tmp_path / "uav1.yaml"
    file.write_text("node: uav1\nagreement: {members: [uav1, uav2, ground]}\n")
    with rabit.Node(config=file, agreement=ALONE, **one_network) as node:
        assert node.claims.acquire("cell 17").wait(120)


def test_a_claim_is_won_held_and_released(one_network):
    node = rabit.Node("uav1", agreement=ALONE, **one_network)
    claim = node.claims.acquire("cell 17")
    assert claim.wanted and not claim.still_mine and "no gateway" in claim.reason
    with node:
        assert claim.wait(120)
        assert claim.still_mine and claim.fence > 0 and claim.holder == "uav1" and claim.reason == ""
        claims = node.claims
        assert claims.mine() == ["cell 17"] and claims.still_mine("cell 17") and claims.fence("cell 17") == claim.fence
        assert claims.holder("cell 17") == "uav1" and claims.holder("cell 18") == "" and claims.fence("cell 18") is None
        first = claim.fence
        claim.release()
        assert not claim.still_mine and not claim.wanted and claim.fence is None and not claim.wait(120)
        with claims.acquire("cell 17") as again:
            assert again.wait(120) and again.fence > first
        assert claims.mine() == []
    with pytest.raises(RuntimeError, match="was stopped"):
        node.claims.acquire("cell 17")
    assert not node.claims.still_mine("cell 17")


def test_names_of_claims_are_bounded(one_network):
    claims = rabit.Node("uav1", agreement=ALONE, **one_network).claims
    for name in ("", "c" * 65):
        with pytest.raises(ValueError, match="claim: expected 1 to 64 bytes"):
            claims.acquire(name)
    assert all(claims.acquire(f"cell {number}").wanted for number in range(64))
    refused = claims.acquire("cell 64")
    assert not refused.wanted and "64 claims are wanted" in refused.reason and not refused.wait(120)


def test_one_of_three_gets_a_claim_and_the_next_one_a_higher_fence(one_network):
    with contextlib.ExitStack() as nodes:
        ground, uav1, uav2 = (nodes.enter_context(rabit.Node(name, agreement=THREE, **one_network))
                              for name in THREE["members"])
        first = uav1.claims.acquire("leader")
        assert first.wait(120)
        fence = first.fence
        wait_until(lambda: ground.claims.holder("leader") == "uav1")
        once = uav2.claims.acquire("leader", once=True)
        assert not once.wait(120) and once.reason and not once.wanted
        second = uav2.claims.acquire("leader")
        first.release()
        assert second.wait(120) and second.fence > fence


def test_an_event_loop_waits_for_a_claim_and_for_its_loss(one_network):
    async def main():
        async with rabit.Node("uav1", agreement=ALONE, **one_network) as node:
            claim = node.claims.acquire("cell 17")
            assert await claim
            lost = asyncio.create_task(claim.lost())
            await asyncio.sleep(0)
            claim.release()
            await lost
            assert not await claim

    asyncio.run(asyncio.wait_for(main(), 120))


def test_a_thread_learns_that_a_claim_is_lost(one_network):
    with rabit.Node("uav1", agreement=ALONE, **one_network) as node:
        claim = node.claims.acquire("cell 17")
        assert claim.wait(120) and not claim.wait_lost(0.01)
        lost = []
        thread = threading.Thread(target=lambda: lost.append(claim.wait_lost(120)))
        thread.start()
        claim.release()
        thread.join()
        assert lost == [True]


def test_the_end_of_the_node_ends_the_waits(one_network):
    node = rabit.Node("uav1", agreement={"members": ["uav1", "uav2", "uav3"]}, **one_network)
    won = []
    with node:
        claim, other = node.claims.acquire("cell 17"), node.claims.acquire("cell 18")  # in vain: nobody else is there
        thread = threading.Thread(target=lambda: won.append(claim.wait()))
        thread.start()
        assert not claim.wait(0.1)
    thread.join()
    assert won == [False]
    assert not other.wait()  # also a wait that begins after the end


class Lead(rabit.Manager):
    period = 3600.0
    wake_on_agreement = True

    def __init__(self):
        self.woken = threading.Event()

    def unit_of_work(self):
        if self.node.claims.still_mine("leader"):
            self.woken.set()


def test_a_claim_that_is_won_wakes_a_manager(one_network):
    lead = Lead()
    with rabit.Node("uav1", agreement=ALONE, managers=[lead], **one_network) as node:
        node.claims.acquire("leader")
        assert lead.woken.wait(120)


def test_the_table_has_texts_sets_and_numbers(one_network):
    node = rabit.Node("uav1", agreement=ALONE, **one_network)
    with pytest.raises(RuntimeError, match="does not run yet"):
        node.table.write("wind", "12 m/s")
    with node:
        table = node.table
        assert table.read("wind") is None and table.keys() == []
        assert table.write("wind", "12 m/s") == "" and table.read("wind") == "12 m/s"
        assert table.write("wind", "") == "" and table.read("wind") == ""
        assert table.add("flown", 17) == "" and table.add("flown", 0) == "" and table.read("flown") == {0, 17}
        assert table.raise_("sorties", 4) == "" and table.raise_("sorties", -2) == "" and table.read("sorties") == 4
        assert sorted(table.keys()) == ["flown", "sorties", "wind"]
        assert table.write("\udcff", "\udcfe") == "" and table.read("\udcff") == "\udcfe"
        assert "another merge" in table.add("wind", 1) and table.read("wind") == ""


def test_the_bounds_of_the_table_are_errors(one_network):
    with rabit.Node("uav1", agreement=ALONE, **one_network) as node:
        table = node.table
        for refused in (lambda: table.write("", "x"), lambda: table.write("k" * 65, "x"), lambda: table.write("k", "x" * 65),
                        lambda: table.add("k", -1), lambda: table.add("k", 512)):
            with pytest.raises(ValueError, match="expected"):
                refused()
        with pytest.raises(TypeError):
            table.raise_("k", 2**63)
        assert table.keys() == []


def test_nodes_that_have_met_have_the_same_table(network):
    agreement = {"members": ["ground", "uav1"]}
    with rabit.Node("uav1", agreement=agreement, **network) as uav, rabit.Node("ground", agreement=agreement, **network) as ground:
        uav.table.add("flown", 3)
        ground.table.add("flown", 5)
        wait_until(lambda: uav.table.read("flown") == ground.table.read("flown") == {3, 5})


def test_a_forked_process_holds_nothing(one_network):
    child = run(program(one_network, """
        with rabit.Node("uav1", agreement={"members": ["uav1"]}, **network) as node:
            claim = node.claims.acquire("leader")
            assert claim.wait(120)
            def in_child():
                assert not claim.still_mine and node.claims.mine() == []
                claim.release()
                try:
                    node.claims.acquire("leader")
                except RuntimeError as error:
                    assert "forked" in str(error), error
                else:
                    assert False
            forked(in_child)()
            assert claim.still_mine
        """))
    output, errors = child.communicate(timeout=120)
    assert child.returncode == 0, errors


def test_the_code_of_the_manual_runs(one_network, tmp_path, monkeypatch, capsys):
    (block,) = re.findall(r"^```python\n(.*?)^```$", (ROOT / "docs/how_to/agree.md").read_text(), re.MULTILINE | re.DOTALL)
    (tmp_path / "uav1.yaml").write_text(json.dumps({"node": "uav1", "agreement": ALONE, **one_network}))
    monkeypatch.chdir(tmp_path)
    exec(block, {})
    assert "cell 23 leg 3 under fence" in capsys.readouterr().out
