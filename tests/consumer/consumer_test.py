"""Installs the build into a prefix of its own, builds projects outside the tree against it, and runs their programs:
two managers in a process, for each pair of backends that were built two nodes with messages of their own IDL, and the
template with its test and its flight in the lab."""

import pathlib
import sys
import tempfile

import consumer


def main():
    cmake, build, transports = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3].split(",")
    consumer.harness.enter_namespace()
    with tempfile.TemporaryDirectory(prefix="rabit_consumer_") as folder:
        folder = pathlib.Path(folder)
        consumer.run(cmake, "--install", build, "--prefix", folder / "prefix")
        programs = consumer.build(cmake, "programs", folder, folder / "prefix")
        consumer.run_two_managers(programs / "two_managers")
        consumer.run_types(programs / "types")
        consumer.run_simulated(programs / "simulated")
        consumer.run_again(programs / "again", folder)
        for first in transports:
            for second in transports:
                consumer.exchange(programs / "node", first, second)
        consumer.build_template(cmake, folder, folder / "prefix")
        consumer.fly_template(folder, folder / "prefix")


if __name__ == "__main__":
    main()
