// Selects the samples kept for each instance: the last ones, and none after the instance has ended.
#pragma once

#include <rabit/base/Assert.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace Rabit::FastDds
{

// The sample numbers in a history, by instance. Every call takes one look-up, however many instances and
// samples there are. Not thread-safe.
template <typename Key, typename Hash>
class KeepLast
{
public:
    // Keeps at most `depth` samples of each instance, at least one.
    explicit KeepLast(std::size_t depth) : _depth(depth) {}

    // The sample that a new one of this instance pushes out; empty if there is room.
    std::optional<std::uint64_t> PushedOut(const Key &instance) const
    {
        const auto found = _instances.find(instance);
        if (found == _instances.end() || found->second.Size() < _depth)
        {
            return std::nullopt;
        }
        return found->second.Numbers[found->second.First];
    }

    // The oldest sample of this instance, if its number is at most `number`.
    std::optional<std::uint64_t> OldestUpTo(const Key &instance, std::uint64_t number) const
    {
        const auto found = _instances.find(instance);
        if (found == _instances.end() || found->second.Size() == 0)
        {
            return std::nullopt;
        }
        const std::uint64_t oldest = found->second.Numbers[found->second.First];
        return oldest <= number ? std::optional(oldest) : std::nullopt;
    }

    // The instance ends with this sample: later readers need neither it nor the samples before it.
    void End(const Key &instance, std::uint64_t number)
    {
        _instances[instance].End = number;
        _lastEnd = number;
    }
    // True if the instance ended with this sample or a later one. Reads no key unless some instance ended
    // that late.
    bool HasEnded(const Key &instance, std::uint64_t number) const
    {
        if (number > _lastEnd)
        {
            return false;
        }
        const auto found = _instances.find(instance);
        return found != _instances.end() && number <= found->second.End;
    }

    // Adds a sample. Numbers must rise.
    void Add(const Key &instance, std::uint64_t number)
    {
        auto &numbers = _instances[instance].Numbers;
        RABIT_ASSERT(numbers.empty() || numbers.back() < number);
        numbers.push_back(number);
    }

    // Removes a sample, for any reason. An unknown number is ignored.
    void Remove(const Key &instance, std::uint64_t number)
    {
        const auto found = _instances.find(instance);
        if (found == _instances.end())
        {
            return;
        }
        found->second.Remove(number);
        if (found->second.Size() == 0 && _instances.size() > MostEmpty)
        {
            _instances.erase(found);
        }
    }

    std::size_t Instances() const { return _instances.size(); }

private:
    // Instances without samples that are kept, so that a few instances that are written again and again cause
    // no allocation.
    static constexpr std::size_t MostEmpty = 256;

    // In rising order. The oldest is removed by advancing First, without moving the others.
    struct Samples
    {
        std::vector<std::uint64_t> Numbers;
        std::size_t First = 0;
        std::uint64_t End = 0;  // the last number with which the instance ended

        std::size_t Size() const { return Numbers.size() - First; }

        void Remove(std::uint64_t number)
        {
            const auto begin = Numbers.begin() + static_cast<std::ptrdiff_t>(First);
            const auto found = std::lower_bound(begin, Numbers.end(), number);
            if (found == Numbers.end() || *found != number)
            {
                return;
            }
            if (found != begin)
            {
                Numbers.erase(found);
                return;
            }
            ++First;
            if (2 * First >= Numbers.size())
            {
                Numbers.erase(Numbers.begin(), Numbers.begin() + static_cast<std::ptrdiff_t>(First));
                First = 0;
            }
        }
    };

    const std::size_t _depth;
    std::uint64_t _lastEnd = 0;  // of all instances
    std::unordered_map<Key, Samples, Hash> _instances;
};

}  // namespace Rabit::FastDds
