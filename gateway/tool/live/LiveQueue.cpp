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
    const std::size_t size = SizeOf(*value);
    const std::uint32_t number = value->Channel;
    for (auto same = _values.find(number); same != _values.end() && _bytes + size > _most;
         same = _values.find(number))
    {
        static_cast<void>(TakeFirstOf(same));
        ++_dropped[number];
    }
    if (_bytes + size > _most)
    {
        ++_dropped[number];
        return;
    }
    _bytes += size;
    _values[number].push_back({++_turn, {subscription, std::move(value)}});
}

LiveQueue::Value LiveQueue::TakeFirstOf(std::map<std::uint32_t, std::deque<Waiting>>::iterator channel)
{
    Value first = std::move(channel->second.front().What);
    _bytes -= SizeOf(*first.What);
    channel->second.pop_front();
    if (channel->second.empty())
    {
        _values.erase(channel);
    }
    return first;
}

void LiveQueue::Remove(std::uint32_t subscription)
{
    for (auto &[number, waiting] : _values)
    {
        std::erase_if(waiting,
                      [&](const Waiting &one)
                      {
                          const bool isOf = one.What.Subscription == subscription;
                          _bytes -= isOf ? SizeOf(*one.What.What) : 0;
                          return isOf;
                      });
    }
    std::erase_if(_values, [](const auto &channel) { return channel.second.empty(); });
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
