#include "LinkValidation.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace Rabit
{

namespace
{

constexpr std::uint8_t KnownFlags = LinkFlagSkip | LinkFlagRedelivered | LinkFlagFirst | LinkFlagLast;

bool IsNoneOrPossible(std::uint64_t incarnation)
{
    return incarnation == 0 || IsPossibleIncarnation(incarnation);
}

bool IsWellFormed(const LinkItem &item)
{
    if ((item.Flags & ~KnownFlags) != 0 || item.TtlLeft < LinkNoExpiry || item.Sequence == 0)
    {
        return false;
    }
    const bool first = (item.Flags & LinkFlagFirst) != 0;
    if ((item.Flags & LinkFlagSkip) != 0)
    {
        return item.Through >= item.Sequence && item.Through - item.Sequence < LinkWindowParts &&
               item.Type.empty() && item.Payload.empty();
    }
    const bool named = item.Type.size() <= LinkMaxName && item.TypeNumber <= LinkMaxTypes &&
                       (item.TypeNumber < LinkMaxTypes || !item.Type.empty());
    return item.Through == item.Sequence && (first ? named : item.Type.empty());
}

bool IsWellFormed(const LinkData &data)
{
    if (data.Link == 0 || data.Queue.size() > LinkMaxName || data.Oldest == 0 || data.Items.empty() ||
        data.Items.size() > LinkMaxItems)
    {
        return false;
    }
    std::uint64_t before = data.Oldest - 1;
    for (const LinkItem &item : data.Items)
    {
        // All within a window from the oldest.
        if (!IsWellFormed(item) || item.Sequence <= before || item.Through - data.Oldest >= LinkWindowParts)
        {
            return false;
        }
        before = item.Through;
    }
    return before < std::numeric_limits<std::uint64_t>::max() - LinkWindowParts;
}

bool IsWellFormed(const LinkAck &ack)
{
    if (ack.Link == 0 || !ack.Open)
    {
        return ack.Link != 0 && ack.Cumulative == 0;
    }
    return ack.Oldest >= 1 && ack.Oldest <= ack.Cumulative + 1 &&
           ack.Cumulative + 1 - ack.Oldest <= LinkWindowParts &&
           ack.Cumulative < std::numeric_limits<std::uint64_t>::max() - LinkWindowParts;
}

void Require(bool condition, const char *what)
{
    if (!condition)
    {
        throw std::invalid_argument(std::string("queue link: ") + what);
    }
}

// Such that the sum of two does not overflow.
bool IsPossibleTime(std::int64_t nanoseconds)
{
    return nanoseconds >= 0 && nanoseconds < (std::int64_t{1} << 62);
}

}  // namespace

bool IsPossibleName(std::string_view name)
{
    return !name.empty() && name.size() <= LinkMaxName;
}

bool IsPossibleIncarnation(std::uint64_t incarnation)
{
    return incarnation != 0 && (incarnation >> 32) != std::numeric_limits<std::uint32_t>::max();
}

bool IsWellFormed(const LinkFrame &frame)
{
    if (frame.Version != LinkVersion || !IsPossibleName(frame.Source) || !IsPossibleTime(frame.Time) ||
        !IsPossibleTime(frame.Echo.Time) || !IsPossibleTime(frame.Echo.HeldFor) ||
        frame.Acks.size() > LinkMaxAcks)
    {
        return false;
    }
    if (!frame.Short && (!IsPossibleIncarnation(frame.SenderLife) || !IsNoneOrPossible(frame.ReceiverLife) ||
                         frame.Clock == 0 || (!frame.IsHello() && frame.ReceiverLife == 0)))
    {
        return false;
    }
    return (!frame.HasData || IsWellFormed(frame.Data)) &&
           std::all_of(frame.Acks.begin(), frame.Acks.end(),
                       [](const LinkAck &ack) { return IsWellFormed(ack); });
}

void RequireValid(const LinkSettings &settings)
{
    Require(IsPossibleName(settings.Node), "Node must have 1 to 255 bytes");
    Require(settings.Clock != 0, "Clock must not be 0");
    Require(settings.MaxDatagram >= 100, "MaxDatagram must be at least 100");
    Require(settings.AckDelay >= LinkTime(0), "AckDelay must not be negative");
    Require(settings.AckEvery >= 1, "AckEvery must be at least 1");
    Require(settings.AckEveryBytes >= 1, "AckEveryBytes must be at least 1");
    Require(settings.MinResend > LinkTime(0), "MinResend must be positive");
    Require(settings.MinResend <= settings.FirstResend && settings.FirstResend <= settings.MaxResend,
            "MinResend <= FirstResend <= MaxResend must hold");
    Require(settings.MaxResend <= std::chrono::hours(1), "MaxResend must be at most an hour");
    Require(settings.QueueingTarget > LinkTime(0), "QueueingTarget must be positive");
    Require(settings.PathMemory > LinkTime(0), "PathMemory must be positive");
    Require(settings.HelloPeriod > LinkTime(0), "HelloPeriod must be positive");
    Require(settings.HelloPeriod <= settings.SilentHelloPeriod, "HelloPeriod <= SilentHelloPeriod must hold");
    Require(settings.HelloGap >= LinkTime(0), "HelloGap must not be negative");
    Require(settings.SilentAfter >= settings.HelloPeriod, "SilentAfter must not be below HelloPeriod");
    Require(settings.RaiseGap >= LinkTime(0), "RaiseGap must not be negative");
    Require(settings.MaxPeers >= 1 && settings.MaxLinksPerPeer >= 1,
            "MaxPeers and MaxLinksPerPeer must be >= 1");
}

void RequireValid(const LinkOptions &options)
{
    Require(options.Capacity >= 1, "Capacity must be at least 1");
    Require(options.Window >= 1 && options.Window <= LinkMaxWindow, "Window must be 1 to LinkMaxWindow");
    Require(options.Expire >= LinkTime(0) && options.Expire <= std::chrono::hours(24 * 365),
            "Expire must be 0 to a year");
}

}  // namespace Rabit
