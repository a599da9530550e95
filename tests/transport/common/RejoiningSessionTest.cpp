// The session that follows the host's networks, over a backend of the test's own, under the test's time.
#include "common/RejoiningSession.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "Networks.h"

namespace
{

using namespace Rabit;
using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// The calls that the backend got, and the answers that it is to give.
struct Script
{
    std::vector<TransportSettings> Opened;
    std::vector<std::string> Writers;  // topics of those that are open
    std::vector<std::string> Readers;
    bool IsOpen = false;
    bool Refuses = false;       // to open a session
    std::string RefusedTopic;   // by name
    std::string RefusedConfig;  // why
    bool OwnNetworks = false;
    bool FindsNetworks = false;
    bool Duplicates = false;
    std::vector<PeerPlace> Places;
    PeerHandler OnPeer;
    std::shared_ptr<TopicRegistry> Topics;
    std::function<void()> InOpen;
    std::atomic<bool> Blocks{false};  // a Write
    std::atomic<bool> IsWriting{false};
};

void Forget(std::vector<std::string> &topics, const std::string &topic)
{
    topics.erase(std::find(topics.begin(), topics.end(), topic));
}

class ScriptedWriter final : public TransportWriter
{
public:
    ScriptedWriter(Script &script, const std::string &topic) : _script(script), _topic(topic)
    {
        _script.Writers.push_back(topic);
    }
    ~ScriptedWriter() override { Forget(_script.Writers, _topic); }
    WriteResult Write(const SampleEncoder &, std::int64_t) override
    {
        _script.IsWriting = true;
        _script.Blocks.wait(true);
        _script.IsWriting = false;
        return WriteResult::Ok;
    }
    WriteResult WriteTo(const std::string &, const SampleEncoder &, std::int64_t) override
    {
        return WriteResult::Failed;
    }
    WriteResult Dispose(const SampleEncoder &, std::int64_t) override { return WriteResult::Ok; }
    int MatchedReaders() const override { return 3; }

private:
    Script &_script;
    const std::string _topic;
};

class ScriptedReader final : public TransportReader
{
public:
    ScriptedReader(Script &script, const std::string &topic) : _script(script), _topic(topic)
    {
        _script.Readers.push_back(topic);
    }
    ~ScriptedReader() override { Forget(_script.Readers, _topic); }
    int MatchedWriters() const override { return 4; }

private:
    Script &_script;
    const std::string _topic;
};

class ScriptedSession final : public BackendSession
{
public:
    explicit ScriptedSession(Script &script) : _script(script) { _script.IsOpen = true; }
    ~ScriptedSession() override
    {
        EXPECT_THAT(_script.Writers, IsEmpty());
        EXPECT_THAT(_script.Readers, IsEmpty());
        _script.IsOpen = false;
    }
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &,
                                                  const std::vector<std::string> &) override
    {
        if (topic.Name == _script.RefusedTopic)
        {
            throw TransportError("no " + topic.Name);
        }
        return std::make_unique<ScriptedWriter>(_script, topic.Name);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &,
                                                  const std::vector<std::string> &, SampleHandler) override
    {
        return std::make_unique<ScriptedReader>(_script, topic.Name);
    }
    std::vector<PeerPlace> PeerPlaces() const override { return _script.Places; }

private:
    Script &_script;
};

class ScriptedBackend final : public RejoiningBackend
{
public:
    explicit ScriptedBackend(Script &script) : _script(script) {}
    std::unique_ptr<BackendSession> Open(const TransportSettings &settings,
                                         const SessionContext &context) override
    {
        EXPECT_FALSE(_script.IsOpen);
        if (_script.InOpen)
        {
            _script.InOpen();
        }
        if (_script.Refuses)
        {
            throw TransportError("no free port", "domain");
        }
        _script.Opened.push_back(settings);
        _script.OnPeer = context.OnPeer;
        _script.Topics = context.Topics;
        context.Log->SamplesLost(5);
        return std::make_unique<ScriptedSession>(_script);
    }
    void CheckConfig(const TransportSettings &) const override
    {
        if (!_script.RefusedConfig.empty())
        {
            throw TransportError(_script.RefusedConfig, "backend_config");
        }
    }
    bool HasOwnNetworks(const TransportSettings &) const override { return _script.OwnNetworks; }
    bool FindsNetworks() const override { return _script.FindsNetworks; }
    bool IsMisledByDuplicates() const override { return _script.Duplicates; }

private:
    Script &_script;
};

class Sample final : public SampleEncoder
{
public:
    std::size_t EncodedSize() const override { return 4; }
    bool Encode(std::span<std::uint8_t>) const override { return true; }
};

const HostNetwork Wired = Network(2, "eth0", "10.0.0.1");
const HostNetwork Radio = Network(3, "radio0", "10.1.0.1");

class RejoiningSessionTest : public testing::Test
{
protected:
    RejoiningSessionTest()
    {
        _settings.Node = "uav1";
        _settings.Log = [this](const std::string &line) { _log.push_back(line); };
    }

    std::unique_ptr<RejoiningSession> Open()
    {
        return std::make_unique<RejoiningSession>(
            _settings, [this](const PeerEvent &event) { _events.push_back(event); },
            std::make_shared<ScriptedBackend>(_script),
            RejoiningSession::Host{[this] { return _canList ? std::optional(_networks) : std::nullopt; },
                                   [this] { return _now; },
                                   [this](const std::string &name)
                                   {
                                       const auto found = _names.find(name);
                                       return found == _names.end() ? std::nullopt
                                                                    : std::optional(found->second);
                                   }});
    }
    // Looks as often as the session asks for, for at most a minute of the test's time.
    void Follow(RejoiningSession &session)
    {
        constexpr int MostLooks = 1000;
        const auto end = _now + 1min;
        int looks = 0;
        for (auto again = session.Look(); again && _now < end && looks < MostLooks; again = session.Look())
        {
            _now += *again;
            ++looks;
        }
        EXPECT_LT(looks, MostLooks);
    }
    std::vector<std::string> Entries(const RejoiningSession &session)
    {
        std::vector<std::string> entries;
        for (const SettingsProblem &problem : session.NetworkProblems())
        {
            entries.push_back(problem.Entry);
        }
        return entries;
    }

    Script _script;
    TransportSettings _settings;
    std::vector<HostNetwork> _networks{Wired};
    bool _canList = true;  // the networks
    std::map<std::string, std::string> _names;
    std::chrono::steady_clock::time_point _now{1000h};
    std::vector<PeerEvent> _events;
    std::vector<std::string> _log;
    const TopicDescription _pose{"Pose", "Uav::Pose", {}};
};

TEST_F(RejoiningSessionTest, OpensWithTheAddressesThatAreThere)
{
    _networks = {Loopback(), Wired, Radio};
    const auto session = Open();
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, ElementsAre("10.0.0.1", "10.1.0.1"));
}

// As without a free descriptor. The kernel reports no change when they can be listed again.
TEST_F(RejoiningSessionTest, LooksAgainForNetworksThatCannotBeListed)
{
    _canList = false;
    const auto session = Open();
    EXPECT_THAT(_script.Opened, IsEmpty());
    ASSERT_EQ(session->NetworkProblems().size(), 1u);
    EXPECT_THAT(session->NetworkProblems()[0].Text, HasSubstr("cannot be listed"));
    EXPECT_EQ(session->Look(), 1000ms);
    _canList = true;
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(session->NetworkProblems(), IsEmpty());
    _canList = false;
    EXPECT_EQ(session->Look(), 1000ms) << "it goes on with its networks";
    EXPECT_TRUE(_script.IsOpen);
}

TEST_F(RejoiningSessionTest, LeavesTheChoiceToABackendThatFindsNetworksUnlessTheyAreNamed)
{
    _script.FindsNetworks = true;
    {
        const auto session = Open();
        EXPECT_THAT(_script.Opened.back().Interfaces, IsEmpty());
    }
    _settings.Interfaces = {"eth0"};
    const auto session = Open();
    EXPECT_THAT(_script.Opened.back().Interfaces, ElementsAre("10.0.0.1"));
}

TEST_F(RejoiningSessionTest, DoesNotWaitForInterfacesThatTheConfigurationFileReplaces)
{
    _script.OwnNetworks = true;
    _settings.Interfaces = {"radio99"};
    const auto session = Open();
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, IsEmpty());
    EXPECT_THAT(Entries(*session), IsEmpty());
}

TEST_F(RejoiningSessionTest, WaitsForANamedInterfaceAndSaysSo)
{
    _settings.Interfaces = {"radio0"};
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    const auto reader = session->CreateReader(_pose, {}, {}, {});
    EXPECT_THAT(_script.Opened, IsEmpty());
    EXPECT_THAT(Entries(*session), ElementsAre("radio0"));
    EXPECT_EQ(writer->Write(Sample(), 1), WriteResult::TimedOut);
    EXPECT_EQ(writer->Dispose(Sample(), 1), WriteResult::TimedOut);
    EXPECT_EQ(writer->MatchedReaders(), 0);
    EXPECT_EQ(reader->MatchedWriters(), 0);
    EXPECT_EQ(session->Counters().WriteTimeouts, 2u);
    EXPECT_THAT(_log, Not(Contains(HasSubstr("timed out")))) << "the missing interface is the reason";

    _networks = {Wired, Radio};
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, ElementsAre("10.1.0.1"));
    EXPECT_THAT(Entries(*session), IsEmpty());
    EXPECT_EQ(writer->Write(Sample(), 1), WriteResult::Ok);
    EXPECT_EQ(writer->MatchedReaders(), 3);
    EXPECT_EQ(reader->MatchedWriters(), 4);
}

TEST_F(RejoiningSessionTest, SaysWhatIsMissingNow)
{
    _settings.Interfaces = {"eth0", "radio0"};
    const auto session = Open();
    _networks = {Wired, WithoutCarrier(Radio)};
    session->Look();
    const auto problems = session->NetworkProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].Text, "the interface radio0 has no carrier: waiting for it");
}

TEST_F(RejoiningSessionTest, RefusesABadConfigurationFileAlsoWhileItWaits)
{
    _settings.Interfaces = {"radio0"};
    _script.RefusedConfig = "not XML";
    EXPECT_THROW(Open(), TransportError);
}

TEST_F(RejoiningSessionTest, RefusesImpossibleTopicsAlsoWhileItWaits)
{
    _networks = {};
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    EXPECT_THROW(session->CreateWriter({"Pose", "Uav::Goto", {}}, {}, {}), TransportError);
    EXPECT_THROW(session->CreateReader({"", "Uav::Goto", {}}, {}, {}, {}), TransportError);
    TopicQos deep;
    deep.Depth = 0;
    EXPECT_THROW(session->CreateReader(_pose, deep, {}, {}), TransportError);
}

TEST_F(RejoiningSessionTest, ThrowsIfTheBackendDoesNotOpenAtFirst)
{
    _script.Refuses = true;
    EXPECT_THROW(Open(), TransportError);
}

TEST_F(RejoiningSessionTest, OpensAllWritersAndReadersAnewForANetworkThatComes)
{
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    const auto reader = session->CreateReader(_pose, {}, {}, {});
    session->CreateWriter({"Gone", "Uav::Pose", {}}, {}, {});
    _networks = {Wired, Radio};
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 2u);
    EXPECT_THAT(_script.Opened[1].Interfaces, ElementsAre("10.0.0.1", "10.1.0.1"));
    EXPECT_THAT(_script.Writers, ElementsAre("Pose"));
    EXPECT_THAT(_script.Readers, ElementsAre("Pose"));
    EXPECT_EQ(writer->Write(Sample(), 1), WriteResult::Ok);
}

TEST_F(RejoiningSessionTest, LosesEachPeerAsOftenAsItAppeared)
{
    const auto session = Open();
    _script.OnPeer({PeerEvent::Kind::Appeared, "ground", 1});
    _script.OnPeer({PeerEvent::Kind::Appeared, "ground", 1});
    _script.OnPeer({PeerEvent::Kind::Appeared, "uav2", 7});
    _script.OnPeer({PeerEvent::Kind::Left, "uav2", 7});
    _events.clear();
    _networks = {Wired, Radio};
    Follow(*session);
    ASSERT_EQ(_events.size(), 2u);
    for (const PeerEvent &event : _events)
    {
        EXPECT_EQ(event.What, PeerEvent::Kind::Lost);
        EXPECT_EQ(event.Node, "ground");
    }
}

TEST_F(RejoiningSessionTest, KnowsNoTopicOfOthersThatItHasNotFoundAnew)
{
    const auto session = Open();
    _script.Topics->RemoteAppeared({.IsWriter = true, .Topic = "Pose", .Type = "Uav::Pose"});
    EXPECT_THAT(session->RemoteTopics(), ElementsAre("Pose"));
    EXPECT_EQ(session->RemoteEndpointsOn("Pose").size(), 1u);
    _networks = {Wired, Radio};
    Follow(*session);
    EXPECT_THAT(session->RemoteTopics(), IsEmpty());
}

TEST_F(RejoiningSessionTest, CountersNeverFallAndAreReadWhileTheNetworkIsJoined)
{
    const auto session = Open();
    EXPECT_EQ(session->Counters().SamplesLost, 5u);
    std::uint64_t meanwhile = 0;
    _script.InOpen = [&] { std::jthread([&] { meanwhile = session->Counters().SamplesLost; }); };
    _networks = {Wired, Radio};
    Follow(*session);
    EXPECT_EQ(meanwhile, 5u);
    EXPECT_EQ(session->Counters().SamplesLost, 10u);
}

TEST_F(RejoiningSessionTest, NobodyWaitsInWriteWhileTheNetworkIsJoined)
{
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    const auto reader = session->CreateReader(_pose, {}, {}, {});
    std::vector<WriteResult> results;
    // Writes on a thread of its own, as the gateway does. If Write waited, the thread could not end before
    // the network is joined.
    _script.InOpen = [&]
    {
        std::jthread(
            [&]
            {
                for (int i = 0; i < 100; ++i)
                {
                    results.push_back(writer->Write(Sample(), 1));
                }
                EXPECT_EQ(writer->MatchedReaders(), 0);
                EXPECT_EQ(reader->MatchedWriters(), 0);
            });
    };
    _networks = {Wired, Radio};
    Follow(*session);
    EXPECT_THAT(results, testing::SizeIs(100));
    EXPECT_THAT(results, testing::Each(WriteResult::TimedOut));
}

TEST_F(RejoiningSessionTest, AWriteUnderWayEndsBeforeItsWriterIsClosed)
{
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    _script.Blocks = true;
    WriteResult result = WriteResult::Failed;
    std::jthread writing([&] { result = writer->Write(Sample(), 1); });
    while (!_script.IsWriting)
    {
        std::this_thread::yield();
    }
    _networks = {Wired, Radio};
    std::jthread following([&] { Follow(*session); });
    while (writer->MatchedReaders() != 0)  // turned away: the session wants to join
    {
        std::this_thread::yield();
    }
    EXPECT_THAT(_script.Writers, ElementsAre("Pose"));
    _script.Blocks = false;
    _script.Blocks.notify_all();
    following.join();
    writing.join();
    EXPECT_EQ(result, WriteResult::Ok);
    EXPECT_EQ(_script.Opened.size(), 2u);
}

TEST_F(RejoiningSessionTest, TriesAgainAfterAFailureAndSaysSo)
{
    const auto session = Open();
    _script.Refuses = true;
    _networks = {Wired, Radio};
    for (int i = 0; i < 4; ++i)
    {
        _now += session->Look().value_or(0ms);
    }
    EXPECT_FALSE(_script.IsOpen);
    const auto problems = session->NetworkProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].Text, "cannot join the network: no free port");
    EXPECT_EQ(problems[0].Setting, "domain");
    _script.Refuses = false;
    Follow(*session);
    EXPECT_TRUE(_script.IsOpen);
    EXPECT_THAT(Entries(*session), IsEmpty());
}

TEST_F(RejoiningSessionTest, DoesNotTryAgainAtOnceAfterAFailure)
{
    const auto session = Open();
    int attempts = 0;
    _script.InOpen = [&] { ++attempts; };
    _script.Refuses = true;
    _networks = {Wired, Radio};
    for (int i = 0; i < 100 && attempts == 0; ++i)
    {
        _now += session->Look().value_or(0ms);
    }
    EXPECT_EQ(session->Look(), 1000ms);
    EXPECT_EQ(attempts, 1);
}

TEST_F(RejoiningSessionTest, AnEndpointThatCannotBeMadeAnewClosesTheOthersUntilItCan)
{
    const auto session = Open();
    const auto first = session->CreateWriter(_pose, {}, {});
    const auto second = session->CreateWriter({"Goto", "Uav::Goto", {}}, {}, {});
    _script.RefusedTopic = "Goto";
    _networks = {Wired, Radio};
    for (int i = 0; i < 4; ++i)
    {
        _now += session->Look().value_or(0ms);
    }
    EXPECT_FALSE(_script.IsOpen);
    EXPECT_EQ(first->Write(Sample(), 1), WriteResult::TimedOut);
    _script.RefusedTopic.clear();
    Follow(*session);
    EXPECT_THAT(_script.Writers, ElementsAre("Pose", "Goto"));
}

TEST_F(RejoiningSessionTest, APeerIsLookedUpAgainUntilItHasAnAddress)
{
    _settings.Peers = {"ground:7410", "10.0.0.7", "uav2"};
    _names["uav2"] = "10.0.0.3";
    const auto session = Open();
    EXPECT_THAT(_script.Opened[0].Peers, ElementsAre("10.0.0.7", "10.0.0.3"));
    EXPECT_THAT(Entries(*session), ElementsAre("ground:7410"));
    Follow(*session);
    EXPECT_EQ(_script.Opened.size(), 1u);
    EXPECT_EQ(session->Look(), 500ms);
    _names["ground"] = "10.0.0.9";
    Follow(*session);
    EXPECT_EQ(session->Look(), std::nullopt);
    ASSERT_EQ(_script.Opened.size(), 2u);
    EXPECT_THAT(_script.Opened[1].Peers, ElementsAre("10.0.0.9:7410", "10.0.0.7", "10.0.0.3"));
    EXPECT_THAT(Entries(*session), IsEmpty());
}

TEST_F(RejoiningSessionTest, ANetworkWhoseAddressAnotherHostHasIsLeftOutIfThatMisleadsTheBackend)
{
    _networks = {Wired, Radio};
    _script.Places = {{"10.0.0.1", "10.1.0.2"}};
    {
        const auto session = Open();
        Follow(*session);
        EXPECT_EQ(_script.Opened.size(), 1u);
    }
    _script.Duplicates = true;
    const auto session = Open();
    _script.Opened.clear();
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, ElementsAre("10.1.0.1"));
    EXPECT_THAT(Entries(*session), ElementsAre("eth0"));
}

}  // namespace
