#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Rabit::Tool
{

// A value of a channel, shared by all viewers that it is sent to.
struct LiveValue
{
    std::uint32_t Channel = 0;
    std::uint64_t Time = 0;  // when it came, UTC in nanoseconds since 1970
    std::vector<std::uint8_t> Bytes;
};

// Texts and values that wait for one viewer. Texts go first. Values take a limited number of bytes. If a new
// value has no room, the oldest values of its subscription are dropped. So a slow viewer sees fewer values of
// busy channels. If that is not enough, the new value is dropped too, unless it is of a State: the viewer
// would show the former value until the next change. So of each subscription to a State one value may exceed
// the limit; the server holds that value anyway. Drops are counted by channel. Not thread-safe.
class LiveQueue
{
public:
    static constexpr std::size_t MostTexts = 1000;

    explicit LiveQueue(std::size_t mostBytes) : _most(mostBytes) {}

    // Returns false if MostTexts wait already: the viewer does not read them.
    bool AddText(std::string text);
    void AddValue(std::uint32_t subscription, std::shared_ptr<const LiveValue> value);
    void AddState(std::uint32_t subscription, std::shared_ptr<const LiveValue> value);
    // Drops the values that wait for that subscription.
    void Remove(std::uint32_t subscription);

    struct Value
    {
        std::uint32_t Subscription = 0;
        std::shared_ptr<const LiveValue> What;
    };
    std::optional<std::string> TakeText();
    // Takes values in the order in which they came.
    std::optional<Value> TakeValue();
    bool IsEmpty() const { return _texts.empty() && _values.empty(); }
    std::size_t Bytes() const { return _bytes; }

    // Returns the numbers of dropped values since the last call, by channel.
    std::map<std::uint32_t, std::uint64_t> TakeDropped();

private:
    struct Waiting
    {
        std::uint64_t Turn = 0;  // rises with each value added
        Value What;
    };
    static std::size_t SizeOf(const LiveValue &value);
    bool HasRoomFor(std::size_t size) const { return _bytes + size <= _most; }
    // Drops the oldest values of the subscription until there is room, or none is left.
    void MakeRoom(std::uint32_t subscription, std::size_t size);
    void Append(std::uint32_t subscription, std::shared_ptr<const LiveValue> value);
    Value TakeFirstOf(std::map<std::uint32_t, std::deque<Waiting>>::iterator subscription);

    const std::size_t _most;
    std::deque<std::string> _texts;
    std::map<std::uint32_t, std::deque<Waiting>> _values;  // by subscription; none is empty
    std::uint64_t _turn = 0;
    std::size_t _bytes = 0;  // of the values
    std::map<std::uint32_t, std::uint64_t> _dropped;
};

}  // namespace Rabit::Tool
