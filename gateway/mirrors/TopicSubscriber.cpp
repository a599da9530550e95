#include "mirrors/TopicSubscriber.h"

#include <rabit/RabitLog.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "clocks/GpsTime.h"
#include "names/NamePattern.h"
#include "presence/PeerTable.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

// Backends may round a time to a microsecond; two posts as close as that differ in content or do not matter.
constexpr std::int64_t Rounding = 2000;

// Nodes that are kept of one message; one more for programs that are no nodes.
constexpr std::size_t MostSources = PeerTable::MaximumPeers + 1;

std::uint64_t HashOf(SampleBytes bytes)
{
    return std::hash<std::string_view>{}(
        std::string_view(reinterpret_cast<const char *>(bytes.data()), bytes.size()));
}

}  // namespace

TopicSubscriber::TopicSubscriber(const SubscribeRule &rule, QosProfile profile, const MessageType &type,
                                 const OriginTable &origins, RabitWorkspace &workspace)
    : _rule(rule),
      _profile(profile),
      _type(type),
      _origins(origins),
      _workspace(workspace),
      _scratch(type.Create())
{
}

TopicSubscriber::~TopicSubscriber()
{
    _reader.reset();  // first: its handler uses the rest
}

void TopicSubscriber::Open(TransportSession &session)
{
    _reader = session.CreateReader(
        GatewayTopics::Describe(_rule.Message, _type), GatewayTopics::QosOf(_profile), _rule.From,
        [this](SampleBytes bytes, const SampleInfo &info) { OnSample(bytes, info); });
}

int TopicSubscriber::MatchedWriters() const
{
    return _reader ? _reader->MatchedWriters() : 0;
}

std::shared_ptr<TopicSubscriber::Source> TopicSubscriber::SourceOf(std::string_view node)
{
    const std::lock_guard lock(_mutex);
    const auto found = _sources.find(node);
    if (found != _sources.end())
    {
        return found->second;
    }
    if (_sources.size() >= MostSources)
    {
        // Whoever was never heard, or has been forgotten, makes room.
        const auto unknown =
            std::find_if(_sources.begin(), _sources.end(),
                         [this](const auto &source) { return !_origins.Find(source.first); });
        if (unknown != _sources.end())
        {
            _sources.erase(unknown);
        }
    }
    if (_sources.size() >= MostSources || (!node.empty() && !IsNodeName(node)))
    {
        ++_crowdedOut;
        return nullptr;
    }
    auto source = std::make_shared<Source>();
    source->Counters.message = _rule.Message;
    source->Counters.node = node;
    return _sources.emplace(node, std::move(source)).first->second;
}

void TopicSubscriber::Forget(const std::string &node)
{
    const std::lock_guard lock(_mutex);
    _sources.erase(node);
}

std::uint64_t TopicSubscriber::CrowdedOut() const
{
    const std::lock_guard lock(_mutex);
    return _crowdedOut;
}

void TopicSubscriber::Register(Source &source)
{
    const std::string name = source.Counters.node + "/" + _rule.Message;
    const std::shared_ptr<RabitMessage> message = _type.CreateShared();
    std::string problem;
    if (!_workspace.AddPublishSubscribeMessage(name, message))
    {
        problem = "the local message `" + name + "` is of another type than `" + _type.Name() + "`";
    }
    const std::lock_guard lock(_mutex);
    source.Global = problem.empty() ? message->GetGlobalPublishSubscribeMessageRef() : nullptr;
    source.Problem = problem;
}

bool TopicSubscriber::IsRepetition(const Source &source, const SampleInfo &info, std::uint64_t hash) const
{
    return _profile == QosProfile::State && source.AnyPosted && source.Incarnation == info.Incarnation &&
           source.LastHash == hash && std::llabs(source.LastTime - info.SourceTime) <= Rounding;
}

// What the network held up while the two nodes lost each other comes after what followed it: DDS keeps the
// order only as long as a match lasts.
bool TopicSubscriber::IsOvertaken(const Source &source, const SampleInfo &info)
{
    return source.AnyPosted && source.Incarnation == info.Incarnation &&
           info.SourceTime < source.LastTime - Rounding;
}

void TopicSubscriber::CountUndecodable(Source &source, std::size_t size)
{
    const std::lock_guard lock(_mutex);
    ++source.Counters.undecodable;
    if (source.Log.MayPass(_workspace.GetClock().Monotonic()))
    {
        RabitLog::Write(
            RabitLogLevel::Warning,
            "gateway: a sample of " + std::to_string(size) + " bytes of `" + _rule.Message + "` from " +
                (source.Counters.node.empty() ? "a program that is no node" : source.Counters.node) +
                " does not decode as `" + _type.Name() + "` (" + std::to_string(source.Counters.undecodable) +
                " so far)");
    }
}

void TopicSubscriber::OnSample(SampleBytes bytes, const SampleInfo &info)
{
    if (!info.Alive)
    {
        return;
    }
    const std::shared_ptr<Source> source = SourceOf(info.Node);
    if (!source)
    {
        return;
    }
    const auto origin = _origins.Find(info.Node);
    const bool known = !info.Node.empty() && origin && origin->Incarnation == info.Incarnation;
    const auto posted =
        known ? origin->PostedAt(info.SourceTime, _workspace.GetClock().Monotonic()) : std::nullopt;
    if (!posted || IsOvertaken(*source, info))
    {
        const std::lock_guard lock(_mutex);
        ++source->Counters.refused;
        return;
    }
    const std::uint64_t hash = _profile == QosProfile::State ? HashOf(bytes) : 0;
    if (IsRepetition(*source, info, hash))
    {
        const std::lock_guard lock(_mutex);
        ++source->Counters.repeated;
        return;
    }
    if (!_type.Deserialize(bytes, *_scratch))
    {
        CountUndecodable(*source, bytes.size());
        return;
    }
    if (!source->Global)
    {
        Register(*source);
    }
    if (!source->Global)
    {
        const std::lock_guard lock(_mutex);
        ++source->Counters.refused;
        return;
    }
    const double stamp = GpsTime::ToGps(info.SourceTime + origin->SourceToWall.count());
    source->Global->PostMessage(_scratch.get(), PostTime{stamp, *posted});
    source->AnyPosted = true;
    source->Incarnation = info.Incarnation;
    source->LastTime = info.SourceTime;
    source->LastHash = hash;
    const std::lock_guard lock(_mutex);
    ++source->Counters.received;
}

std::uint64_t TopicSubscriber::ReceivedFrom(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _sources.find(node);
    return found == _sources.end() ? 0 : found->second->Counters.received;
}

std::vector<Gateway::TopicStatus> TopicSubscriber::Status() const
{
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::TopicStatus> status;
    for (const auto &[node, source] : _sources)
    {
        status.push_back(source->Counters);
    }
    return status;
}

std::string TopicSubscriber::LocalProblem(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _sources.find(node);
    return found == _sources.end() ? "" : found->second->Problem;
}

}  // namespace Rabit
