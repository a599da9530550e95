// A session in a process of its own, with whatever keys it is given: the vendors must find the faults in
// these. For the tests of this folder:
//   secured_peer <transport> <node> <domain> <folder> <level> [<interface> [<lease in seconds> [words]]]
// The folder is `-` for none. Writes and reads the topic State, in the partition of its node and of all. With
// `words`, State is a topic of strings as in ROS 2, for the vendors' own programs. Prints a line for each
// event:
//   open                     the session, its writer and its reader are there
//   failed <why>             they are not
//   appeared <node>          and `gone <node>`
//   heard <node> <count>     the first sample of this node, and the tenth, the twentieth ...
//   said <node> <text>       a sample of this node does not have its name as text; the first ten
//   log <line>
// Ends with its standard input. The environment variable SECURED_PEER_BACKEND_CONFIG names a file of the
// vendor's.
#include <rabit/transport/TransportFactory.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

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

struct Options
{
    std::string Interface = "lo";
    int LeaseSeconds = 10;
    bool Words = false;
};

Rabit::TransportSettings SettingsFrom(char **argv, const Options &options)
{
    Rabit::TransportSettings settings;
    settings.Node = argv[2];
    settings.Incarnation = 1;
    settings.Domain = std::stoi(argv[3]);
    settings.Interfaces = {options.Interface};
    settings.Lease = std::chrono::seconds(options.LeaseSeconds);
    settings.Memory = settings.Lease;
    settings.AnnouncementPeriod = std::chrono::milliseconds(500);
    settings.Log = [](const std::string &line) { Say("log " + line); };
    if (const char *file = std::getenv("SECURED_PEER_BACKEND_CONFIG"))
    {
        settings.BackendConfig = file;
    }
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

// After the encapsulation comes a string, with a key before it unless the topic is one of `words`.
std::string TextIn(Rabit::SampleBytes bytes, bool words)
{
    const std::vector<std::uint8_t> key(4);
    std::vector<std::uint8_t> whole(bytes.begin(), bytes.end());
    if (words && whole.size() >= 4)
    {
        whole.insert(whole.begin() + 4, key.begin(), key.end());
    }
    return Rabit::Conformance::TextOf(whole);
}

Rabit::Conformance::RawSample SampleOf(const std::string &text, bool words)
{
    if (!words)
    {
        return Rabit::Conformance::MakeSample(1, text);
    }
    const auto size = static_cast<std::uint8_t>(text.size() + 1);
    std::vector<std::uint8_t> body = {size, 0, 0, 0};
    body.insert(body.end(), text.begin(), text.end());
    body.push_back(0);
    return Rabit::Conformance::RawSample(std::move(body));
}

class Listener
{
public:
    explicit Listener(bool words) : _words(words) {}

    void operator()(Rabit::SampleBytes bytes, const Rabit::SampleInfo &info)
    {
        const std::string node(info.Node.empty() ? "nobody" : info.Node);
        if (!info.Alive)
        {
            return;
        }
        const unsigned count = _counts.Next(node);
        if (count == 1 || count % 10 == 0)
        {
            Say("heard " + node + " " + std::to_string(count));
        }
        const std::string text = TextIn(bytes, _words);
        if (text != node && _others.Next(node) <= 10)
        {
            Say("said " + node + " " + text);
        }
    }

private:
    const bool _words;
    Counts _counts;
    Counts _others;
};

void Run(char **argv, const Options &options)
{
    using namespace Rabit::Conformance;
    const Rabit::TransportSettings settings = SettingsFrom(argv, options);
    const auto session = Rabit::MakeTransport(argv[1])->Open(
        settings, [](const Rabit::PeerEvent &event)
        { Say((event.What == Rabit::PeerEvent::Kind::Appeared ? "appeared " : "gone ") + event.Node); });
    const Rabit::TopicDescription topic =
        options.Words ? Rabit::TopicDescription{"State", "std_msgs::msg::dds_::String_", {}}
                      : TextTopic("State");
    Listener listener(options.Words);
    const auto reader = session->CreateReader(
        topic, Telemetry(), options.Words ? std::vector<std::string>{"*", ""} : std::vector<std::string>{"*"},
        std::ref(listener));
    const auto writer = session->CreateWriter(topic, Telemetry(), {"", settings.Node});
    Say("open");
    std::atomic<bool> stopped{false};
    std::thread writing(
        [&]
        {
            while (!stopped)
            {
                writer->Write(SampleOf(settings.Node, options.Words), 1);
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
    if (argc < 6 || argc > 9)
    {
        std::cerr << "usage: secured_peer <transport> <node> <domain> <folder> <level> [<interface> [<lease> "
                     "[words]]]\n";
        return 2;
    }
    try
    {
        Options options;
        options.Interface = argc > 6 ? argv[6] : options.Interface;
        options.LeaseSeconds = argc > 7 ? std::stoi(argv[7]) : options.LeaseSeconds;
        options.Words = argc > 8;
        Run(argv, options);
        return 0;
    }
    catch (const std::exception &error)
    {
        Say(std::string("failed ") + error.what());
        return 1;
    }
}
