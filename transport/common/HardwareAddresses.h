#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "common/RecentMap.h"

namespace Rabit
{

// The hosts to which the kernel cannot send yet, since it does not know their hardware addresses.
//
// The kernel asks for a hardware address by broadcast (ARP, RFC 826) and asks again after a second. It keeps
// the datagrams to the host until an answer comes, or drops them after three requests in vain. Over a radio
// that loses 40 % of the datagrams this takes up to ten seconds. The kept datagrams fill the buffer of the
// socket, which then blocks its writers. A datagram to a multicast group needs no hardware address, so
// datagrams for such a host go to a group instead. One datagram a second also goes to the host, because the
// kernel asks only if there is one. Receivers drop duplicates.
//
// Thread-safe. Calls only `Read`, with its lock held.
class HardwareAddresses
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::steady_clock::duration;
    using Host = std::array<std::uint8_t, 4>;  // IPv4
    // Returns the kernel's table, as /proc/net/arp has it.
    using Read = std::function<std::string()>;

    // The kernel's table is read again after this time: for a host whose address is awaited, and for others.
    static constexpr std::chrono::milliseconds Unknown{20};
    static constexpr std::chrono::milliseconds Known{1000};
    // A host without an entry may get one by the first datagram to it. A host that has had none for this
    // long is taken for one of another network, whose datagrams go to a router.
    static constexpr std::chrono::seconds NewFor{2};
    // Hosts without an entry that are remembered at most.
    static constexpr std::size_t MostAbsent = 1024;

    // Interval between datagrams to a host whose address is awaited.
    static constexpr std::chrono::seconds AskAgain{1};

    // A node that was not heard for this long gets nothing by the group. The longest beat period, twice.
    static constexpr std::chrono::seconds InReach{120};

    explicit HardwareAddresses(Read read = &OfKernel) : _read(std::move(read)) {}

    // True if the kernel has asked for the address and has had no answer yet. False before anything was sent
    // to the host, and for hosts of other networks and of this computer: the kernel does not ask for those.
    bool IsAwaited(const Host &host, TimePoint now);
    // True if a datagram to this awaited host must also go to the host itself. True at once, and again after
    // AskAgain.
    bool HasToAsk(const Host &host, TimePoint now);
    // False if the host is awaited and has not to be asked again: a datagram to it would only wait.
    bool MayAsk(const Host &host, TimePoint now) { return !IsAwaited(host, now) || HasToAsk(host, now); }

private:
    static std::string OfKernel();
    Duration RereadAfter(const Host &host, TimePoint now);
    void Refresh(TimePoint now);

    const Read _read;
    std::mutex _mutex;
    std::optional<TimePoint> _readAt;  // guarded by _mutex, like the members below
    std::set<Host> _known;
    std::map<Host, std::optional<TimePoint>> _awaited;  // when a datagram went to the host
    RecentMap<Host, TimePoint> _absent{MostAbsent};     // since when it has had no entry
};

}  // namespace Rabit
