#!/usr/bin/env python3
"""What a doctor finds.

Usage: doctor_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import pathlib
import re
import signal
import socket
import subprocess
import sys
import threading

from two_aircraft import LIMIT, SWARM, Rabit, harness, is_well, keys, main


def a_doctor_finds_nothing_wrong_with_a_fleet_that_is_well(rabit):
    def well():
        findings, done = rabit.objects("doctor", "--wait", "4")
        return findings if is_well(done) else None

    findings = harness.until(well)
    assert all(keys(finding) == ["level", "subject", "text", "advice"] for finding in findings), findings
    said = {finding["subject"]: finding["text"] for finding in findings}
    assert {"interface lo", "nodes", "clocks", "multicast on lo"} <= set(said), findings
    assert {"uav1", "uav2"} <= set(said["nodes"].split()), said
    assert "answered by 127.0.0.1" in said["multicast on lo"], said


def a_doctor_is_answered_by_a_node_that_is_alone_over_each_dds(rabit):
    domain = (rabit.domain + 50) % 200
    for transport in sys.argv[3].split(","):
        with harness.Processes() as processes:
            processes.start([rabit.uav, "--config", SWARM / "uav.yaml", "--node", "alone", "--domain", domain,
                             "--transport", transport])

            def answered():
                done = Rabit(rabit.program, rabit.transport, domain).run("doctor", "--wait", "6")
                return "nodes: alone" in done.stdout and "answered by 127.0.0.1" in done.stdout \
                    and "did not answer" not in done.stdout
            harness.until(answered)


def a_doctor_tells_of_the_domain_that_the_others_are_in(rabit):
    other = (rabit.domain + 100) % 200

    def named():
        done = Rabit(rabit.program, rabit.transport, other).run("doctor", "--wait", "4")
        assert done.returncode == 3 and "nobody was heard" in done.stderr, done
        return re.search(rf"^! domain {rabit.domain}: .*uav1.*--domain {rabit.domain}", done.stdout, re.MULTILINE)
    harness.until(named)


def a_doctor_that_hears_nobody_listens_until_nodes_of_all_domains_must_have_announced_themselves(rabit):
    silent = 57  # it is not asked
    with harness.Processes() as processes:
        processes.start([rabit.uav, "--config", SWARM / "uav.yaml", "--node", "away", "--domain", str(silent),
                         "--transport", rabit.transport])

        def is_there():
            return "away" in Rabit(rabit.program, rabit.transport, silent).run("nodes").stdout
        harness.until(is_there)
        done = Rabit(rabit.program, rabit.transport, silent + 1).run("doctor")
        assert done.returncode == 3 and f"! domain {silent}: away is in it" in done.stdout, done


def a_doctor_tells_of_two_nodes_of_one_name_and_of_an_interface_that_is_not_there(rabit):
    with harness.Processes() as processes:
        for _ in range(2):
            processes.start([rabit.uav, "--config", SWARM / "uav.yaml", "--node", "twin", "--domain", rabit.domain,
                             "--transport", rabit.transport])

        def twice():
            done = rabit.run("doctor", "--wait", "6")
            return "! node twin: two live nodes have this name. Do: give one of them another one" in done.stdout
        harness.until(twice)
    done = subprocess.run([rabit.program, "doctor", "--interface", "nosuch0", "--wait", "1"], capture_output=True,
                          text=True, timeout=LIMIT, check=False)
    assert done.returncode == 3 and "! interface nosuch0: this machine has none. Do: name one of " in done.stdout, done


class LocalProgram:
    """A DDS program that takes announcements at the loopback address of this machine alone, as ROS 2 has it with
    ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST: it answers each with its own."""

    IDENTITY = bytes(range(1, 13))

    def __init__(self, domain):
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 7410 + 250 * domain + 2 * 30))
        self._thread = threading.Thread(target=self._answer)

    def _answer(self):
        while True:
            datagram, sender = self._socket.recvfrom(65536)
            if not datagram:
                return
            self._socket.sendto(datagram.replace(datagram[8:20], self.IDENTITY), sender)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._socket.sendto(b"", self._socket.getsockname())
        self._thread.join()
        self._socket.close()


def a_doctor_tells_of_a_program_that_takes_no_multicast(rabit):
    with LocalProgram(rabit.domain):
        findings, done = rabit.objects("doctor", "--wait", "4")
    (finding,) = [finding for finding in findings if finding["subject"] == "this machine alone"]
    assert finding["level"] == "problem" and "(0102030405060708090a0b0c) is in domain" in finding["text"], finding
    assert "127.0.0.1" in finding["advice"] and done.returncode == 1, done


def takes_interrupts(process):
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    masks = [int(mask, 16) for mask in re.findall(r"^Sig(?:Blk|Cgt):\s*([0-9a-f]+)", status, re.MULTILINE)]
    return any(mask & 1 << signal.SIGINT - 1 for mask in masks)


def a_doctor_that_is_interrupted_has_no_report(rabit):
    with subprocess.Popen(rabit.argv("doctor", "--wait", "60"), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as doctor:
        # The program blocks SIGINT, for a thread that waits for it, before all else.
        harness.until(lambda: takes_interrupts(doctor.pid))
        doctor.send_signal(signal.SIGINT)
        shown, told = doctor.communicate(timeout=LIMIT)
    assert doctor.returncode == 130 and shown == "" and re.search("interrupted after .* of 60 s", told), (shown, told)


TESTS = [a_doctor_that_is_interrupted_has_no_report, a_doctor_finds_nothing_wrong_with_a_fleet_that_is_well,
         a_doctor_is_answered_by_a_node_that_is_alone_over_each_dds, a_doctor_tells_of_the_domain_that_the_others_are_in,
         a_doctor_that_hears_nobody_listens_until_nodes_of_all_domains_must_have_announced_themselves,
         a_doctor_tells_of_a_program_that_takes_no_multicast,
         a_doctor_tells_of_two_nodes_of_one_name_and_of_an_interface_that_is_not_there]


if __name__ == "__main__":
    main(TESTS)
