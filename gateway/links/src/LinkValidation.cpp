#include "LinkValidation.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace Rabit
{

namespace
{

constexpr std::uint8_t KnownFlags = LinkFlagSkip | LinkFlagRedelivered;

bool AreNames(std::string_view source, std::string_view destination)
{
    return IsPossibleName(source) && IsPossibleName(destination) && source != destination;
}

bool IsNoneOrPossible(std::uint64_t incarnation)
{
    return incarnation == 0 || IsPossibleIncarnation(incarnation);
}

bool IsWellFormed(const LinkItem &item)
{
    if ((item.Flags & ~KnownFlags) != 0 || item.TtlLeft < LinkNoExpiry)
    {
        return false;
    }
    if ((item.Flags & LinkFlagSkip) != 0)
    {
        return item.Type.empty() && item.Payload.empty();
    }
    return IsPossibleName(item.Type);
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

bool IsWellFormed(const LinkData &data)
{
    return data.Version == LinkVersion && AreNames(data.Source, data.Destination) &&
           IsPossibleName(data.Queue) && IsPossibleIncarnation(data.SenderIncarnation) &&
           IsPossibleIncarnation(data.ReceiverIncarnation) && data.Base >= 1 && data.First >= data.Base &&
           data.First <= std::numeric_limits<std::uint64_t>::max() - LinkMaxItems && data.Echo.Clock != 0 &&
           data.Echo.Time >= 0 && data.Echo.HeldFor >= 0 && data.SentAt >= 0 && !data.Items.empty() &&
           data.Items.size() <= LinkMaxItems &&
           std::all_of(data.Items.begin(), data.Items.end(),
                       [](const LinkItem &item) { return IsWellFormed(item); });
}

bool IsWellFormed(const LinkAck &ack)
{
    return ack.Version == LinkVersion && AreNames(ack.Source, ack.Destination) && IsPossibleName(ack.Queue) &&
           IsPossibleIncarnation(ack.ReceiverIncarnation) && IsNoneOrPossible(ack.SenderIncarnation) &&
           (ack.SenderIncarnation != 0 || ack.Cumulative == 0) && ack.Clock != 0 && ack.Time >= 0 &&
           IsNoneOrPossible(ack.YourIncarnation) && IsPossibleTime(ack.EchoSentAt) &&
           IsPossibleTime(ack.EchoHeldFor);
}

bool IsWellFormed(const LinkHello &hello)
{
    return hello.Version == LinkVersion && AreNames(hello.Source, hello.Destination) &&
           IsPossibleIncarnation(hello.Incarnation) && IsNoneOrPossible(hello.YourIncarnation) &&
           hello.Clock != 0 && hello.Time >= 0;
}

void RequireValid(const LinkSettings &settings)
{
    Require(IsPossibleName(settings.Node), "Node must have 1 to 255 bytes");
    Require(settings.Clock != 0, "Clock must not be 0");
    Require(settings.AckDelay >= LinkTime(0), "AckDelay must not be negative");
    Require(settings.AckEvery >= 1, "AckEvery must be at least 1");
    Require(settings.AckEveryBytes >= 1, "AckEveryBytes must be at least 1");
    Require(settings.MinResend > LinkTime(0), "MinResend must be positive");
    Require(settings.MinResend <= settings.FirstResend && settings.FirstResend <= settings.MaxResend,
            "MinResend <= FirstResend <= MaxResend must hold");
    Require(settings.MaxResend <= std::chrono::hours(1), "MaxResend must be at most an hour");
    Require(settings.SlowPath >= 1, "SlowPath must be at least 1");
    Require(settings.ShortRoundTrip >= LinkTime(0), "ShortRoundTrip must not be negative");
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
    Require(options.Window >= 1 && options.Window <= LinkOutcomeBits, "Window must be 1 to LinkOutcomeBits");
    Require(options.Expire >= LinkTime(0) && options.Expire <= std::chrono::hours(24 * 365),
            "Expire must be 0 to a year");
}

}  // namespace Rabit
