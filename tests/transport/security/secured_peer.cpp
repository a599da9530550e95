// A session in a process of its own, with whatever keys it is given: what of them is wrong is left to the
// vendors to find. For strangers_test.py:
//   secured_peer <transport> <node> <domain> <folder> <level>
// The folder is `-` for none. Writes and reads the topic State, in the partition of its node and of all, and
// prints a line for each thing that it sees:
//   open                     the session, its writer and its reader are there
//   failed <why>             they are not
//   appeared <node>          and `gone <node>`
//   heard <node> <count>     the first sample of that node, and the tenth, the twentieth ...
//   log <line>
// Ends with its standard input.
#include <rabit/transport/TransportFactory.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "../conformance/TestSample.h"
#include "keys/Certificates.h"
#include "keys/KeyFiles.h"
#include "keys/NodeKeys.h"

namespace
{

void Say(const std::string &line)
{
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    std::cout << line + "\n" << std::flush;
}

class Counts
{
public:
    unsigned Next(const std::string &node)
    {
        const std::lock_guard lock(_mutex);
        return ++_counts[node];
    }

private:
    std::mutex _mutex;
    std::map<std::string, unsigned> _counts;
};

std::string FleetIn(const std::string &file)
{
    return Rabit::Keys::FleetOf(*Rabit::Keys::ReadCertificate(Rabit::Keys::ReadFile(file), file));
}

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
        const Rabit::Keys::NodeFiles files(folder);
        const bool encrypts = std::string(argv[5]) == "encrypt";
        const std::string fleet = FleetIn(files.IdentityAuthority);
        settings.Security = {
            .IdentityAuthority = files.IdentityAuthority,
            .PermissionsAuthority = files.PermissionsAuthority,
            .Certificate = files.Certificate,
            .PrivateKey = files.PrivateKey,
            .Revoked = files.Revoked,
            .Governance = files.Governance(encrypts ? Rabit::Keys::Level::Encrypt : Rabit::Keys::Level::Sign),
            .Permissions = files.Permissions,
            .Encrypts = encrypts,
            .MayBe = [fleet](std::string_view node, std::span<const std::uint8_t, 12> guidPrefix)
            { return Rabit::Keys::IsGuidOf(fleet, node, guidPrefix); }};
    }
    return settings;
}

void Run(char **argv)
{
    using namespace Rabit::Conformance;
    const Rabit::TransportSettings settings = SettingsFrom(argv);
    const auto session = Rabit::MakeTransport(argv[1])->Open(
        settings, [](const Rabit::PeerEvent &event)
        { Say((event.What == Rabit::PeerEvent::Kind::Appeared ? "appeared " : "gone ") + event.Node); });
    Counts counts;
    const auto reader =
        session->CreateReader(TextTopic("State"), Telemetry(), {"*"},
                              [&counts](Rabit::SampleBytes, const Rabit::SampleInfo &info)
                              {
                                  const std::string node(info.Node.empty() ? "nobody" : info.Node);
                                  const unsigned count = info.Alive ? counts.Next(node) : 0;
                                  if (count == 1 || (count > 0 && count % 10 == 0))
                                  {
                                      Say("heard " + node + " " + std::to_string(count));
                                  }
                              });
    const auto writer = session->CreateWriter(TextTopic("State"), Telemetry(), {"", settings.Node});
    Say("open");
    std::atomic<bool> stopped{false};
    std::thread writing(
        [&]
        {
            while (!stopped)
            {
                writer->Write(MakeSample(1, settings.Node), 1);
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
    if (argc != 6)
    {
        std::cerr << "usage: secured_peer <transport> <node> <domain> <folder> <level>\n";
        return 2;
    }
    try
    {
        Run(argv);
        return 0;
    }
    catch (const std::exception &error)
    {
        Say(std::string("failed ") + error.what());
        return 1;
    }
}
