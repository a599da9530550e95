#include "live/LiveQueue.h"

#include <algorithm>
#include <utility>

#include "live/LiveProtocol.h"

namespace Rabit::Tool
{

std::size_t LiveQueue::SizeOf(const LiveValue &value)
{
    return LiveProtocol::MessageDataHeader + value.Bytes.size();
}

bool LiveQueue::AddText(std::string text)
{
    if (_texts.size() >= MostTexts)
    {
        return false;
    }
    _texts.push_back(std::move(text));
    return true;
}

void LiveQueue::AddValue(std::uint32_t subscription, std::shared_ptr<const LiveValue> value)
{
    MakeRoom(subscription, SizeOf(*value));
    if (!HasRoomFor(SizeOf(*value)))
    {
        ++_dropped[value->Channel];
        return;
    }
    Append(subscription, std::move(value));
}

void LiveQueue::AddState(std::uint32_t subscription, std::shared_ptr<const LiveValue> value)
{
    MakeRoom(subscription, SizeOf(*value));
    Append(subscription, std::move(value));
}

void LiveQueue::MakeRoom(std::uint32_t subscription, std::size_t size)
{
    for (auto same = _values.find(subscription); same != _values.end() && !HasRoomFor(size);
         same = _values.find(subscription))
    {
        ++_dropped[TakeFirstOf(same).What->Channel];
    }
}

void LiveQueue::Append(std::uint32_t subscription, std::shared_ptr<const LiveValue> value)
{
    _bytes += SizeOf(*value);
    _values[subscription].push_back({++_turn, {subscription, std::move(value)}});
}

LiveQueue::Value LiveQueue::TakeFirstOf(std::map<std::uint32_t, std::deque<Waiting>>::iterator subscription)
{
    Value first = std::move(subscription->second.front().What);
    _bytes -= SizeOf(*first.What);
    subscription->second.pop_front();
    if (subscription->second.empty())
    {
        _values.erase(subscription);
    }
    return first;
}

void LiveQueue::Remove(std::uint32_t subscription)
{
    for (auto same = _values.find(subscription); same != _values.end(); same = _values.find(subscription))
    {
        static_cast<void>(TakeFirstOf(same));
    }
}

std::optional<std::string> LiveQueue::TakeText()
{
    if (_texts.empty())
    {
        return std::nullopt;
    }
    std::string text = std::move(_texts.front());
    _texts.pop_front();
    return text;
}

std::optional<LiveQueue::Value> LiveQueue::TakeValue()
{
    const auto next = std::min_element(_values.begin(), _values.end(),
                                       [](const auto &one, const auto &other)
                                       { return one.second.front().Turn < other.second.front().Turn; });
    return next == _values.end() ? std::nullopt : std::optional(TakeFirstOf(next));
}

std::map<std::uint32_t, std::uint64_t> LiveQueue::TakeDropped()
{
    return std::exchange(_dropped, {});
}

}  // namespace Rabit::Tool
