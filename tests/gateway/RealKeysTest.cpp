// A published message whose key changes, over each pair of real backends, on loopback.
#include <gmock/gmock.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/TransportFactory.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../Eventually.h"
#include "BackendPairs.h"
#include "DomainLease.h"
#include "keyed.idl.h"

namespace Rabit
{
namespace
{

using GatewayTest::Contact;
using testing::ElementsAre;
using testing::Pair;

// A node that publishes the message `Contact`.
class PublishingNode
{
public:
    explicit PublishingNode(const std::string &transport) : _reactor(_workspace)
    {
        GatewayConfig config;
        config.Node = "uav1";
        config.Domain = Conformance::OwnDomain();
        config.Interfaces = {"127.0.0.1"};
        config.Publish.push_back({.Message = "Contact", .Type = "GatewayTest::Contact"});
        _workspace.AddPublishSubscribeMessage("Contact", _contact);
        _reactor.SetHandleSignals(false);
        _reactor.AddManager(std::make_unique<GatewayManager>(config, MakeTransport(transport), _workspace));
        _thread = std::thread([this] { _reactor.Run(); });
    }

    ~PublishingNode()
    {
        _reactor.ShutdownAllManagers();
        _thread.join();
    }

    void Post(std::uint32_t number)
    {
        _contact->number = number;
        _contact->PostMessage();
    }

private:
    RabitWorkspace _workspace;
    RabitReactor _reactor;
    std::shared_ptr<Contact> _contact = std::make_shared<Contact>();
    std::thread _thread;
};

// A program that reads the topic and is no node. Keeps the instances as it sees them: alive or not.
class PlainReader
{
public:
    PlainReader(const std::string &transport, const std::string &name)
    {
        TransportSettings settings;
        settings.Node = name;
        settings.Domain = Conformance::OwnDomain();
        settings.Interfaces = {"127.0.0.1"};
        _session = MakeTransport(transport)->Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Durability = Durability::TransientLocal;
        const auto keyOf = [](SampleBytes bytes, KeyHash &key)
        { return Contact::IdlType().KeyHashOf(bytes, key); };
        _reader = _session->CreateReader({"Contact", "GatewayTest::Contact", keyOf}, qos, {},
                                         [this](SampleBytes, const SampleInfo &info) { Take(info); });
    }

    // Waits until this instance alone is alive. Returns all instances that were ever heard of.
    std::map<int, bool> Until(int alive)
    {
        std::unique_lock lock(_mutex);
        EXPECT_TRUE(_changed.wait_for(lock, RabitTest::Hangs,
                                      [&]
                                      {
                                          for (const auto &[number, is] : _instances)
                                          {
                                              if (is != (number == alive))
                                              {
                                                  return false;
                                              }
                                          }
                                          return _instances.contains(alive);
                                      }));
        return _instances;
    }

private:
    void Take(const SampleInfo &info)
    {
        const std::lock_guard lock(_mutex);
        _instances[info.Key[3]] = info.Alive;
        _changed.notify_all();
    }

    std::mutex _mutex;
    std::condition_variable _changed;
    std::map<int, bool> _instances;
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportReader> _reader;
};

// The backends of the node and of its readers.
class RealKeysTest : public ::testing::TestWithParam<std::pair<std::string, std::string>>
{
};

TEST_P(RealKeysTest, AReaderIsToldThatTheFormerInstanceIsGoneAndALateOneHearsOfTheNewestAlone)
{
    PublishingNode node(GetParam().first);
    PlainReader early(GetParam().second, "early");
    for (const int number : {1, 2, 3})
    {
        node.Post(static_cast<std::uint32_t>(number));
        early.Until(number);
    }
    EXPECT_THAT(early.Until(3), ElementsAre(Pair(1, false), Pair(2, false), Pair(3, true)));
    // A reader that comes before the early one has acknowledged may hear of the previous instance. Then
    // another reader is tried.
    std::map<int, bool> heard;
    for (int number = 3; heard.size() != 2 && number < 30; ++number)
    {
        PlainReader late(GetParam().second, std::string("late").append(std::to_string(number)));
        late.Until(number);
        // Samples of a former instance come before the next post's.
        node.Post(static_cast<std::uint32_t>(number + 1));
        heard = late.Until(number + 1);
    }
    EXPECT_EQ(heard.size(), 2u) << "of the one that was there when it came, and of the next";
}

INSTANTIATE_TEST_SUITE_P(Backends, RealKeysTest, ::testing::ValuesIn(AllBackendPairs()), NameOfPair);

}  // namespace
}  // namespace Rabit
