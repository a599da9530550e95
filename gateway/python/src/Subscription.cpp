#include "Subscription.h"

#include <rabit/PublishSubscribeMessage.h>
#include <rabit/SystemTimeClock.h>

#include "Values.h"

namespace Rabit::Python
{
namespace
{

constexpr double GpsEpoch = 315964800.0;  // 1980-01-06 in seconds since 1970

}  // namespace

double Received::Age() const
{
    return std::chrono::duration<double>(RabitClock::System()->Monotonic() - Time.Monotonic).count();
}

double Received::Stamp() const
{
    return Time.GpsTimeSeconds + GpsEpoch - SystemTimeClock::GetSystemTimeClock()->GetLeapSecondOffset();
}

Subscription::Subscription(const std::shared_ptr<RabitWorkspace> &workspace, std::string pattern,
                           std::string message, std::shared_ptr<MessageClass> type)
    : _workspace(workspace),
      _pattern(std::move(pattern)),
      _message(std::move(message)),
      _type(std::move(type))
{
}

void Subscription::Queue(Shared &shared, const std::shared_ptr<Source> &source)
{
    {
        const std::lock_guard lock(shared.Mutex);
        if (source->IsQueued || shared.IsClosed)
        {
            return;
        }
        source->IsQueued = true;
        shared.New.push_back(source);
    }
    shared.Ready.Notify();
}

std::string Subscription::Attach(const std::string &node)
{
    if (HasAttached(node) || IsClosed())
    {
        return "";
    }
    auto source = std::make_shared<Source>();
    source->Workspace = _workspace.lock();
    if (!source->Workspace)
    {
        return "";
    }
    source->Node = node;
    source->LocalName = node.empty() ? _message : node + "/" + _message;
    source->Own = _type->Registered->CreateShared();
    source->Lease = std::make_unique<RabitMessageLease>(*source->Workspace, source->LocalName, source->Own);
    const auto global = source->Lease->Global();
    if (!global)
    {
        return "the local message `" + source->LocalName + "` is of another type than " + _type->Name();
    }
    // The handler wakes only, so it may run on the thread that posts.
    source->Connection = global->ConnectSomethingPublished(RabitQuickHandler(
        [shared = _shared, weak = std::weak_ptr<Source>(source)]
        {
            if (const auto one = weak.lock())
            {
                Queue(*shared, one);
            }
        }));
    {
        const std::lock_guard lock(_shared->Mutex);
        if (_shared->IsClosed)
        {
            return "";  // another thread stops the node: nothing of its workspace may stay
        }
        _sources[node] = source;
    }
    Queue(*_shared, source);  // it may have a value already
    return "";
}

bool Subscription::HasAttached(const std::string &node) const
{
    const std::lock_guard lock(_shared->Mutex);
    return _sources.count(node) != 0;
}

bool Subscription::IsReady() const
{
    const std::lock_guard lock(_shared->Mutex);
    return !_shared->New.empty() || _shared->IsClosed;
}

bool Subscription::IsClosed() const
{
    const std::lock_guard lock(_shared->Mutex);
    return _shared->IsClosed;
}

std::optional<Received> Subscription::Take()
{
    for (;;)
    {
        std::shared_ptr<Source> source;
        {
            const std::lock_guard lock(_shared->Mutex);
            if (_shared->New.empty() || _shared->IsClosed)
            {
                return std::nullopt;
            }
            source = _shared->New.front().lock();
            _shared->New.pop_front();
            if (!source)
            {
                continue;
            }
            source->IsQueued = false;
        }
        if (source->Own->FetchMessage() && source->Own->WasPosted())
        {
            return ReceivedOf(*source);
        }
    }
}

std::vector<Received> Subscription::All()
{
    std::vector<std::shared_ptr<Source>> sources;
    {
        const std::lock_guard lock(_shared->Mutex);
        for (const auto &[node, source] : _sources)
        {
            sources.push_back(source);
        }
    }
    std::vector<Received> all;
    for (const auto &source : sources)
    {
        // A message of its own: what is fetched here was not taken.
        const auto message = source->Own->Clone();
        if (source->Lease->Global()->FetchMessage(message.get()) || message->WasPosted())
        {
            all.push_back(
                {ValueOf(*_type, *message), source->Node, source->LocalName, message->GetPostTime()});
        }
    }
    return all;
}

Received Subscription::ReceivedOf(const Source &source) const
{
    return {ValueOf(*_type, *source.Own), source.Node, source.LocalName, source.Own->GetPostTime()};
}

void Subscription::Close()
{
    std::map<std::string, std::shared_ptr<Source>> sources;
    {
        const std::lock_guard lock(_shared->Mutex);
        _shared->IsClosed = true;
        _shared->New.clear();
        sources.swap(_sources);
    }
    _shared->Ready.Close();
}

}  // namespace Rabit::Python
