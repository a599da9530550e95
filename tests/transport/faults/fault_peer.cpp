// A session in a process of its own, for vendor_faults_test.py:
//   fault_peer <transport> <node> <domain> [<fleet>]
// With the name of a fleet, the node is a member of it (../common/TestMembers.h). Writes its name on the
// topic State, and reads it. Prints a line for each event:
//   appeared <node>          and `gone <node>`
//   heard <node> <count>     the first sample of this node, and the tenth, the twentieth ...
// Ends with its standard input.
#include <poll.h>
#include <rabit/transport/TransportFactory.h>
#include <unistd.h>

#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "../common/TestMembers.h"
#include "../conformance/TestSample.h"

namespace
{

using namespace Rabit::Conformance;

void Say(const std::string &line)
{
    std::cout << line + "\n" << std::flush;
}

Rabit::TransportSettings SettingsOf(int argc, char **argv)
{
    Rabit::TransportSettings settings;
    settings.Node = argv[2];
    settings.Incarnation = 1;
    settings.Domain = std::stoi(argv[3]);
    settings.Interfaces = {"lo"};
    settings.Lease = std::chrono::seconds(10);
    settings.Memory = settings.Lease;
    settings.AnnouncementPeriod = std::chrono::milliseconds(500);
    if (argc == 5)
    {
        settings.Member = TestMembers(argv[4]).Member(settings.Node);
    }
    return settings;
}

// Handlers of one reader never run at once.
class Listener
{
public:
    void operator()(Rabit::SampleBytes /*bytes*/, const Rabit::SampleInfo &info)
    {
        const std::string node(info.Node.empty() ? "nobody" : info.Node);
        const unsigned count = ++_counts[node];
        if (count == 1 || count % 10 == 0)
        {
            Say("heard " + node + " " + std::to_string(count));
        }
    }

private:
    std::map<std::string, unsigned> _counts;
};

void Run(int argc, char **argv)
{
    const Rabit::TransportSettings settings = SettingsOf(argc, argv);
    const auto session = Rabit::MakeTransport(argv[1])->Open(
        settings, [](const Rabit::PeerEvent &event)
        { Say((event.What == Rabit::PeerEvent::Kind::Appeared ? "appeared " : "gone ") + event.Node); });
    Listener listener;
    const auto reader = session->CreateReader(TextTopic("State"), Telemetry(), {}, std::ref(listener));
    const auto writer = session->CreateWriter(TextTopic("State"), Telemetry(), {});
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (poll(&input, 1, 100) == 0)
    {
        writer->Write(MakeSample(1, settings.Node), 1);
    }
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc != 4 && argc != 5)
    {
        std::cerr << "usage: fault_peer <transport> <node> <domain> [<fleet>]\n";
        return 2;
    }
    try
    {
        Run(argc, argv);
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << "\n";
        return 1;
    }
}
