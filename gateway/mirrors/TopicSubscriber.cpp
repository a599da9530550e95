#include "mirrors/TopicSubscriber.h"

#include <rabit/RabitLog.h>
#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "clocks/GpsTime.h"
#include "mirrors/StateVersion.h"
#include "presence/PeerTable.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

// Nodes that are kept of one message; one more for programs that are no nodes.
constexpr std::size_t MostSources = PeerTable::MaximumPeers + 1;

}  // namespace

TopicSubscriber::TopicSubscriber(const SubscribeRule &rule, const MessageType &type,
                                 const OriginTable &origins, RabitWorkspace &workspace,
                                 RabitHandlerThread *handlers, std::shared_ptr<GatewayTap> tap)
    : _rule(rule),
      _type(type),
      _origins(origins),
      _workspace(workspace),
      _handlers(handlers),
      _tap(std::move(tap))
{
}

TopicSubscriber::~TopicSubscriber()
{
    _readers.clear();  // first: their handler uses the rest
}

void TopicSubscriber::Open(TransportSession &session)
{
    _readers.push_back(session.CreateReader(
        GatewayTopics::Describe(_rule.Message, _type), GatewayTopics::QosOf(QosProfile::Telemetry),
        _rule.From, [this](SampleBytes bytes, const SampleInfo &info) { OnSample(bytes, info); }));
}

int TopicSubscriber::MatchedWriters() const
{
    return std::accumulate(_readers.begin(), _readers.end(), 0,
                           [](int sum, const auto &reader) { return sum + reader->MatchedWriters(); });
}

std::shared_ptr<TopicSubscriber::Source> TopicSubscriber::SourceOf(std::string_view node,
                                                                   std::optional<QosProfile> &offer)
{
    const std::lock_guard lock(_mutex);
    const auto found = _sources.find(node);
    if (found != _sources.end())
    {
        offer = found->second->Offer;
        return found->second;
    }
    if (_sources.size() >= MostSources)
    {
        // A node that was never heard, or has been forgotten, makes room.
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
    source->LocalName = source->Counters.node + "/" + _rule.Message;
    source->IsWanted = MatchesAny(_rule.From, node);
    source->IsOtherVersion = _otherVersions.count(node) > 0;
    const auto offered = _offers.find(node);
    source->Offer = offered == _offers.end() ? std::nullopt : std::optional(offered->second);
    offer = source->Offer;
    return _sources.emplace(node, std::move(source)).first->second;
}

void TopicSubscriber::Forget(const std::string &node)
{
    const std::lock_guard lock(_mutex);
    _sources.erase(node);
    _offers.erase(node);
    _otherVersions.erase(node);
}

void TopicSubscriber::SetOffer(const std::string &node, std::optional<QosProfile> profile,
                               bool isOtherVersion)
{
    const std::lock_guard lock(_mutex);
    if (const auto source = _sources.find(node); source != _sources.end())
    {
        source->second->Offer = profile;
        source->second->IsOtherVersion = isOtherVersion;
    }
    if (isOtherVersion)
    {
        _otherVersions.insert(node);
    }
    else
    {
        _otherVersions.erase(node);
    }
    if (profile)
    {
        _offers[node] = *profile;
    }
    else
    {
        _offers.erase(node);
    }
}

std::optional<std::int64_t> TopicSubscriber::TakenIn(const std::string &node, std::uint64_t incarnation) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _sources.find(node);
    if (found == _sources.end() || !found->second->Taken || found->second->Taken->Incarnation != incarnation)
    {
        return std::nullopt;
    }
    return found->second->Taken->Time;
}

std::uint64_t TopicSubscriber::CrowdedOut() const
{
    const std::lock_guard lock(_mutex);
    return _crowdedOut;
}

void TopicSubscriber::Register(Source &source)
{
    source.Local.emplace(_workspace, source.LocalName, _type.CreateShared());
    const bool fits = source.Local->Global() != nullptr;
    if (!fits)
    {
        source.Local.reset();
    }
    const std::lock_guard lock(_mutex);
    source.Problem =
        fits ? ""
             : "the local message `" + source.LocalName + "` is of another type than `" + _type.Name() + "`";
}

bool TopicSubscriber::IsRepetition(const Source &source, const SampleInfo &info)
{
    return source.Posted && source.Posted->Incarnation == info.Incarnation &&
           StateVersion::IsSame(source.Posted->Time, info.SourceTime);
}

// The network does not keep the order: a delayed sample may come long after its successor.
bool TopicSubscriber::IsOvertaken(const Source &source, const SampleInfo &info)
{
    return source.Posted && source.Posted->Incarnation == info.Incarnation &&
           info.SourceTime < source.Posted->Time &&
           !StateVersion::IsSame(info.SourceTime, source.Posted->Time);
}

void TopicSubscriber::LogUndecodable(Source &source, std::size_t size)
{
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
    std::optional<QosProfile> offer;
    if (const std::shared_ptr<Source> source = SourceOf(info.Node, offer))
    {
        const Outcome outcome = [&]
        {
            const std::unique_lock lock =
                _comesTwice ? std::unique_lock(_taking) : std::unique_lock<std::mutex>();
            return Take(*source, offer, bytes, info);
        }();
        Count(*source, outcome, info);
        if (outcome == Outcome::Undecodable)
        {
            LogUndecodable(*source, bytes.size());
        }
    }
}

TopicSubscriber::Outcome TopicSubscriber::Take(Source &source, std::optional<QosProfile> offer,
                                               SampleBytes bytes, const SampleInfo &info)
{
    const auto origin = _origins.Find(info.Node);
    const bool known = !info.Node.empty() && source.IsWanted && !source.IsOtherVersion && origin &&
                       origin->Incarnation == info.Incarnation;
    const auto posted =
        known ? origin->PostedAt(info.SourceTime, _workspace.GetClock().Monotonic()) : std::nullopt;
    if (!posted || IsOvertaken(source, info) || (_rule.Qos == QosProfile::State && offer != _rule.Qos))
    {
        return Outcome::Refused;
    }
    if ((offer == QosProfile::State || _comesTwice) && IsRepetition(source, info))
    {
        return Outcome::Repeated;
    }
    if (!source.Scratch)
    {
        source.Scratch = _type.Create();
    }
    source.Scratch->RabitMessage::Clear();  // it may hold a former post, with ints that a manager here set
    if (!_type.Deserialize(bytes, *source.Scratch))
    {
        return Outcome::Undecodable;
    }
    if (!source.Local)
    {
        Register(source);
    }
    if (!source.Local)
    {
        return Outcome::NotPostable;
    }
    const double stamp = GpsTime::ToGps(info.SourceTime + origin->SourceToWall.count());
    const std::shared_ptr<PublishSubscribeMessage> &global = source.Local->Global();
    const RabitHandlerThread::Scope scope(_handlers, source.LocalName, global);
    global->PostContents(source.Scratch, PostTime{stamp, *posted});
    source.Posted = Sample{info.Incarnation, info.SourceTime};
    if (_tap)
    {
        _tap->Mirrored({info.Node, _rule.Message, info.Incarnation, info.SourceTime, *posted, bytes});
    }
    return Outcome::Posted;
}

void TopicSubscriber::Count(Source &source, Outcome outcome, const SampleInfo &info)
{
    const std::lock_guard lock(_mutex);
    Gateway::TopicStatus &counters = source.Counters;
    counters.received += outcome == Outcome::Posted ? 1 : 0;
    counters.repeated += outcome == Outcome::Repeated ? 1 : 0;
    counters.undecodable += outcome == Outcome::Undecodable ? 1 : 0;
    counters.refused += outcome == Outcome::Refused || outcome == Outcome::NotPostable ? 1 : 0;
    if (outcome == Outcome::Posted)
    {
        source.PostedOf = info.Incarnation;
    }
    if (outcome != Outcome::Refused)
    {
        const bool first = !source.Taken || source.Taken->Incarnation != info.Incarnation;
        source.Taken =
            Sample{info.Incarnation, first ? info.SourceTime : std::max(source.Taken->Time, info.SourceTime)};
    }
}

std::optional<std::uint64_t> TopicSubscriber::PostedOf(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    const auto found = _sources.find(node);
    return found == _sources.end() ? std::nullopt : found->second->PostedOf;
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
