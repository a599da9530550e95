// A session that follows the host's networks, over a backend of the test's own, under the test's time.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Networks.h"
#include "common/RejoiningSession.h"

namespace RejoiningTests
{

using namespace Rabit;
using namespace std::chrono_literals;

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
    std::shared_ptr<SendingTurn> Sending;
    std::function<void()> InOpen;
    std::atomic<bool> Blocks{false};  // a Write
    std::atomic<bool> IsWriting{false};
};

inline void Forget(std::vector<std::string> &topics, const std::string &topic)
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
        EXPECT_THAT(_script.Writers, testing::IsEmpty());
        EXPECT_THAT(_script.Readers, testing::IsEmpty());
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
        _script.Sending = context.Sending;
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

// Counts what is sent at the end of a turn.
class CountedDatagram final : public TurnDatagram
{
public:
    explicit CountedDatagram(int &sent) : _sent(sent) {}
    std::size_t Add(std::span<const std::uint8_t> datagram) override { return datagram.size(); }
    void Send() override { ++_sent; }

private:
    int &_sent;
};

inline const HostNetwork Wired = Network(2, "eth0", "10.0.0.1");
inline const HostNetwork Radio = Network(3, "radio0", "10.1.0.1");

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
    // Writes a datagram in a turn, and ends the turn after `meanwhile`. Returns true if the datagram was
    // sent.
    bool TakesTurn(
        RejoiningSession &session, const std::function<void()> &meanwhile = [] {})
    {
        int sent = 0;
        EXPECT_TRUE(session.BeginTurn(1000));
        EXPECT_TRUE(_script.Sending->IsOfThisThread());
        const std::vector<std::uint8_t> datagram(20);
        _script.Sending->Take({1, 1}, datagram,
                              [&](std::size_t) { return std::make_unique<CountedDatagram>(sent); });
        meanwhile();
        session.EndTurn();
        EXPECT_FALSE(_script.Sending->IsOfThisThread());
        return sent == 1;
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

}  // namespace RejoiningTests
