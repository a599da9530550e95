// A node of its own, for tests that kill one: transport_peer <transport> <node> <incarnation> <domain>
// [<fleet>]
//
// With the name of a fleet, the node is a member of it (../common/TestMembers.h).
// Writes one sample (key 7, "remote") on the topic KeyedText and stays until its standard input ends.
#include <rabit/transport/TransportFactory.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "../common/TestMembers.h"
#include "../conformance/TestSample.h"

int main(int argc, char **argv)
{
    using namespace Rabit::Conformance;
    if (argc != 5 && argc != 6)
    {
        std::cerr << "usage: transport_peer <transport> <node> <incarnation> <domain> [<fleet>]\n";
        return 2;
    }
    try
    {
        Rabit::TransportSettings settings;
        settings.Node = argv[2];
        settings.Incarnation = std::stoull(argv[3]);
        settings.Domain = std::stoi(argv[4]);
        settings.Interfaces = {"lo"};
        settings.Lease = std::chrono::seconds(3);
        settings.AnnouncementPeriod = std::chrono::milliseconds(500);
        if (argc == 6)
        {
            settings.Member = TestMembers(argv[5]).Member(settings.Node);
        }
        const auto session = Rabit::MakeTransport(argv[1])->Open(settings, {});
        const auto writer = session->CreateWriter(KeyedTopic(), State(), {});
        writer->Write(MakeSample(7, "remote"), 1);
        while (std::getchar() != EOF)
        {
        }
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
