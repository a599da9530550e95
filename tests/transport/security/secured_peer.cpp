// A session with DDS Security in a process of its own, for security_test.py:
//   secured_peer <transport> <node> <domain> <folder> <level> [<topic>...]
// Writes and reads each of the topics, State if none is named, in the partition of its node and in all, and
// prints a line for each thing that it sees:
//   open                the session is open
//   failed <why>        it is not
//   appeared <node>     and `gone <node>`
//   heard <topic> <node>     the first sample of that node
//   log <line>
// Ends with its standard input.
#include <rabit/transport/TransportFactory.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "../conformance/TestSample.h"

namespace
{

void Say(const std::string &line)
{
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    std::cout << line + "\n" << std::flush;
}

class FirstOnes
{
public:
    bool IsNew(const std::string &what)
    {
        const std::lock_guard lock(_mutex);
        return _seen.insert(what).second;
    }

private:
    std::mutex _mutex;
    std::set<std::string> _seen;
};

Rabit::TransportSettings SettingsFrom(char **argv)
{
    Rabit::TransportSettings settings;
    settings.Node = argv[2];
    settings.Incarnation = 1;
    settings.Domain = std::stoi(argv[3]);
    settings.Interfaces = {"lo"};
    settings.Lease = std::chrono::seconds(10);
    settings.AnnouncementPeriod = std::chrono::milliseconds(500);
    settings.Log = [](const std::string &line) { Say("log " + line); };
    const std::string folder = argv[4];
    if (folder != "-")
    {
        settings.Security = {.IdentityAuthority = folder + "/identity_ca.pem",
                             .PermissionsAuthority = folder + "/permissions_ca.pem",
                             .Certificate = folder + "/cert.pem",
                             .PrivateKey = folder + "/key.pem",
                             .Revoked = {},
                             .Governance = folder + "/governance_" + argv[5] + ".p7s",
                             .Permissions = folder + "/permissions.p7s",
                             .MayBe = {}};
    }
    return settings;
}

void Run(int argc, char **argv)
{
    using namespace Rabit::Conformance;
    const Rabit::TransportSettings settings = SettingsFrom(argv);
    const auto session = Rabit::MakeTransport(argv[1])->Open(
        settings,
        [](const Rabit::PeerEvent &event)
        { Say((event.What == Rabit::PeerEvent::Kind::Appeared ? "appeared " : "gone ") + event.Node); });
    std::vector<std::string> topics(argv + 6, argv + argc);
    if (topics.empty())
    {
        topics.emplace_back("State");
    }
    FirstOnes heard;
    std::vector<std::unique_ptr<Rabit::TransportWriter>> writers;
    std::vector<std::unique_ptr<Rabit::TransportReader>> readers;
    for (const std::string &topic : topics)
    {
        readers.push_back(session->CreateReader(
            TextTopic(topic), Telemetry(), {"*"},
            [&heard, topic](Rabit::SampleBytes, const Rabit::SampleInfo &info)
            {
                const std::string what = "heard " + topic + " " + std::string(info.Node);
                if (info.Alive && heard.IsNew(what))
                {
                    Say(what);
                }
            }));
        writers.push_back(session->CreateWriter(TextTopic(topic), Telemetry(), {"", settings.Node}));
    }
    Say("open");
    std::atomic<bool> stopped{false};
    std::thread writing(
        [&]
        {
            while (!stopped)
            {
                for (const auto &writer : writers)
                {
                    writer->Write(MakeSample(1, settings.Node), 1);
                }
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
            }
        });
    while (std::getchar() != EOF)
    {
    }
    stopped = true;
    writing.join();
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc < 6)
    {
        std::cerr << "usage: secured_peer <transport> <node> <domain> <folder> <level> [<topic>...]\n";
        return 2;
    }
    try
    {
        Run(argc, argv);
        return 0;
    }
    catch (const std::exception &error)
    {
        Say(std::string("failed ") + error.what());
        return 1;
    }
}
