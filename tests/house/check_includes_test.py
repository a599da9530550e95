#!/usr/bin/env python3
"""Checks that check_includes.py finds what it is there to find."""

import pathlib
import tempfile
import unittest

import check_includes


class CheckIncludes(unittest.TestCase):
    def violations(self, path, text):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / path
            file.parent.mkdir(parents=True)
            file.write_text(text)
            return list(check_includes.violations(pathlib.Path(folder)))

    def test_core_may_not_know_the_gateway(self):
        self.assertEqual(
            self.violations("core/src/A.cpp", "// first\n#include <rabit/gateway/GatewayManager.h>\n"),
            ["core/src/A.cpp:2: core/ must not include <rabit/gateway/GatewayManager.h> (gateway)"])

    def test_core_may_not_know_a_network(self):
        self.assertEqual(len(self.violations("core/src/A.h", "#include <boost/asio.hpp>\n#include <sys/socket.h>\n")), 2)

    def test_only_the_backend_knows_its_vendor(self):
        text = "#include <fastdds/dds/domain/DomainParticipant.hpp>\n"
        self.assertEqual(self.violations("transport/fastdds/src/A.cpp", text), [])
        self.assertEqual(len(self.violations("transport/simulated/src/A.cpp", text)), 1)
        self.assertEqual(len(self.violations("gateway/src/A.cpp", text)), 1)

    def test_the_transport_knows_no_message_class(self):
        self.assertEqual(len(self.violations("transport/fastdds/src/A.cpp", "#include <rabit/RabitMessage.h>\n")), 1)

    def test_the_links_know_nothing_but_themselves(self):
        self.assertEqual(len(self.violations("gateway/links/src/A.cpp", "#include <rabit/RabitMessage.h>\n")), 1)
        self.assertEqual(self.violations("gateway/links/src/A.cpp", "#include <rabit/gateway/links/LinkNode.h>\n"), [])

    def test_the_gateway_names_no_backend(self):
        self.assertEqual(len(self.violations("gateway/src/A.cpp", "#include <rabit/transport/TransportFactory.h>\n")), 1)

    def test_standard_headers_are_for_everybody(self):
        self.assertEqual(self.violations("core/src/A.cpp", "#include <vector>\n#include <boost/bind/bind.hpp>\n"), [])


if __name__ == "__main__":
    unittest.main()
