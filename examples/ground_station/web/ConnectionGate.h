#pragma once

#include <boost/asio/ip/address.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

namespace Ground
{

// Decides which connections a WebServer holds, so that no stranger keeps its page from opening.
//
// A connection is idle until its request is there, and again when it is answered: whoever is there for the
// page says at once what he wants. Where there is no room for one that comes, an idle one goes in its place,
// the oldest of the address that holds the most of them; the idle ones are few in any case. One address holds
// so many at most, and some places are kept for the known: the addresses that opened a page while there was
// room. This machine itself is known, and may hold any number: a tunnel may bring many people from there.
//
// Not thread-safe.
class ConnectionGate
{
public:
    using Address = boost::asio::ip::address;
    using Id = std::uint64_t;

    struct Limits
    {
        std::size_t Most = 64;       // at once
        std::size_t MostIdle = 24;   // of these
        std::size_t MostOfOne = 24;  // of one address, this machine apart
        std::size_t ForKnown = 16;   // places that a stranger does not get
    };
    // Addresses that are remembered; then the oldest is a stranger again.
    static constexpr std::size_t MostKnown = 64;

    struct Decision
    {
        std::optional<Id> Taken;    // by which it is known from now on; nothing: it is to be closed
        std::optional<Id> Dropped;  // is to be closed in its place, and is not counted any more
    };

    explicit ConnectionGate(const Limits &limits) : _limits(limits) {}

    // One more has come. It is idle.
    Decision Arrive(const Address &from);
    // Of one that was taken and not dropped; otherwise these do nothing.
    void BecomesIdle(Id id);
    void BecomesBusy(Id id);
    void OpensPage(Id id);
    void Leaves(Id id) { _open.erase(id); }

    std::size_t Open() const { return _open.size(); }

private:
    struct Connection
    {
        Address From;
        std::uint64_t IdleSince = 0;  // rises; 0: it is not idle
    };

    bool IsKnown(const Address &from) const;
    std::size_t Of(const Address &from) const;
    std::size_t Idle() const;
    std::optional<Id> OldestIdleOf(const Address &from) const;
    std::optional<Id> IdleToDrop() const;

    Limits _limits;
    std::map<Id, Connection> _open;
    std::deque<Address> _known;
    Id _lastId = 0;
    std::uint64_t _lastIdle = 0;
};

}  // namespace Ground
