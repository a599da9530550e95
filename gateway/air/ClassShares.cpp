#include "air/ClassShares.h"

#include <algorithm>
#include <limits>

namespace Rabit
{
namespace
{

constexpr std::size_t Presence = static_cast<std::size_t>(TrafficClass::Presence);
constexpr std::size_t First = static_cast<std::size_t>(TrafficClass::Command);

// Credit of each class in each round, bytes.
constexpr auto Quantum = []
{
    std::array<std::int64_t, TrafficClassCount> quantum{};
    std::transform(TrafficClasses.begin(), TrafficClasses.end(), quantum.begin(),
                   [](const TrafficClassInfo &traffic)
                   { return traffic.Share * ClassShares::BytesPerShare; });
    return quantum;
}();

bool AnyButPresence(const ClassShares::Waiting &waiting)
{
    return std::find(waiting.begin() + First, waiting.end(), true) != waiting.end();
}

}  // namespace

ClassShares::ClassShares() : _credit(Quantum) {}

void ClassShares::SetPresenceBurst(std::int64_t bytes)
{
    _presenceBurst = bytes;
    _presence = std::min(_presence, bytes);
}

TrafficClass ClassShares::Next(const Waiting &waiting)
{
    if (waiting[Presence] && (_presence > 0 || !AnyButPresence(waiting)))
    {
        return TrafficClass::Presence;
    }
    const auto entitled = [this, &waiting]
    {
        std::size_t i = First;
        while (i < TrafficClassCount && !(waiting[i] && _credit[i] > 0))
        {
            ++i;
        }
        return i;
    };
    if (entitled() == TrafficClassCount)
    {
        BeginRounds(waiting);
    }
    return static_cast<TrafficClass>(entitled());
}

// Begins as many rounds as it takes until one of the waiting classes has credit.
void ClassShares::BeginRounds(const Waiting &waiting)
{
    std::int64_t rounds = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = First; i < TrafficClassCount; ++i)
    {
        if (waiting[i])
        {
            rounds = std::min(rounds, -_credit[i] / Quantum[i] + 1);
        }
    }
    for (std::size_t i = First; i < TrafficClassCount; ++i)
    {
        _credit[i] = std::min(_credit[i] + rounds * Quantum[i], Quantum[i]);
    }
}

void ClassShares::Charge(TrafficClass traffic, std::size_t bytes, const Waiting &waiting)
{
    const auto amount = static_cast<std::int64_t>(bytes);
    if (traffic != TrafficClass::Presence)
    {
        _credit[static_cast<std::size_t>(traffic)] -= amount;
        _presence = std::min(_presence + amount / PresenceEarns, _presenceBurst);
    }
    else if (AnyButPresence(waiting))
    {
        _presence -= amount;
    }
    else
    {
        _presence = _presenceBurst;
    }
}

}  // namespace Rabit
