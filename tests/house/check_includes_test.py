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

    def test_all_rooms_but_core_may_know_the_base_which_knows_none(self):
        text = "#include <rabit/base/Fnv1a.h>\n"
        self.assertEqual(self.violations("gateway/links/src/A.cpp", text), [])
        self.assertEqual(self.violations("transport/guard/A.cpp", text), [])
        self.assertEqual(len(self.violations("core/src/A.cpp", text)), 1)
        self.assertEqual(len(self.violations("base/include/rabit/base/A.h", "#include <rabit/RabitMessage.h>\n")), 1)

    def test_core_may_not_know_a_network(self):
        self.assertEqual(len(self.violations("core/src/A.h", "#include <boost/asio.hpp>\n#include <sys/socket.h>\n")), 2)

    def test_only_the_backend_knows_its_vendor(self):
        text = "#include <fastdds/dds/domain/DomainParticipant.hpp>\n"
        self.assertEqual(self.violations("transport/fastdds/src/A.cpp", text), [])
        self.assertEqual(len(self.violations("transport/simulated/src/A.cpp", text)), 1)
        self.assertEqual(len(self.violations("gateway/queues/A.cpp", text)), 1)

    def test_the_transport_knows_no_message_class(self):
        self.assertEqual(len(self.violations("transport/fastdds/src/A.cpp", "#include <rabit/RabitMessage.h>\n")), 1)

    def test_the_links_know_nothing_but_themselves(self):
        self.assertEqual(len(self.violations("gateway/links/src/A.cpp", "#include <rabit/RabitMessage.h>\n")), 1)
        self.assertEqual(self.violations("gateway/links/src/A.cpp", "#include <rabit/gateway/links/LinkNode.h>\n"), [])

    def test_the_gateway_names_no_backend(self):
        self.assertEqual(len(self.violations("gateway/queues/A.cpp", "#include <rabit/transport/TransportFactory.h>\n")), 1)

    def test_rooms_of_the_gateway_look_down_only(self):
        self.assertEqual(self.violations("gateway/queues/A.cpp", '#include "presence/PeerTable.h"\n'), [])
        self.assertEqual(self.violations("gateway/presence/A.cpp", '#include "queues/LinkDriver.h"\n'),
                         ["gateway/presence/A.cpp:1: gateway/presence/ must not include <queues/LinkDriver.h> (room queues)"])
        self.assertEqual(len(self.violations("gateway/mirrors/A.cpp", '#include "report/Diagnosis.h"\n')), 1)
        self.assertEqual(list(check_includes.upward_rooms()), [])

    def test_only_the_configuration_of_the_gateway_reads_yaml(self):
        self.assertEqual(len(self.violations("gateway/presence/A.cpp", "#include <yaml-cpp/yaml.h>\n")), 1)

    def test_a_folder_of_the_gateway_that_is_no_room_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "gateway/attic").mkdir(parents=True)
            (root / "gateway/attic/A.h").write_text("")
            self.assertEqual(len(list(check_includes.rooms_unknown(root))), 1)

    def test_files_of_recordings_know_nothing_but_themselves(self):
        self.assertEqual(self.violations("gateway/recording/mcap/A.cpp", '#include "recording/mcap/Zstd.h"\n#include <zstd.h>\n'), [])
        self.assertEqual(len(self.violations("gateway/recording/mcap/A.cpp", '#include <rabit/RabitMessage.h>\n')), 1)
        self.assertEqual(len(self.violations("gateway/manager/A.cpp", '#include "recording/mcap/Zstd.h"\n')), 1)

    def test_programs_read_recordings_by_public_headers_alone(self):
        self.assertEqual(self.violations("gateway/tool/A.cpp", "#include <rabit/mcap/MessageCursor.h>\n"), [])
        self.assertEqual(len(self.violations("gateway/tool/A.cpp", '#include "recording/mcap/Zstd.h"\n')), 1)

    def test_standard_headers_are_for_everybody(self):
        self.assertEqual(self.violations("core/src/A.cpp", "#include <vector>\n#include <boost/bind/bind.hpp>\n"), [])


if __name__ == "__main__":
    unittest.main()
