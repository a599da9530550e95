#pragma once

#include <boost/asio/ip/address.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

namespace Ground
{

// Decides which connections a WebServer holds, so that no attacker can keep the page from opening.
//
// A connection is idle until its request has arrived, and again after the answer: real browsers send their
// request at once. If there is no room for a new connection, it replaces an idle one: the oldest of the
// address that holds the most idle ones. The number of idle connections is limited, and so is that of one
// address. Some places are reserved for known addresses: those that opened a page while there was room.
// This machine itself is known, and has no limit: a tunnel may bring many people from there.
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
        std::size_t MostOfOne = 24;  // of one address other than this machine
        std::size_t ForKnown = 16;   // places reserved for known addresses
    };
    // Number of known addresses; beyond it the oldest is forgotten.
    static constexpr std::size_t MostKnown = 64;

    struct Decision
    {
        std::optional<Id> Taken;    // the id of the new connection; nothing: close it
        std::optional<Id> Dropped;  // close this one in its place; it no longer counts
    };

    explicit ConnectionGate(const Limits &limits) : _limits(limits) {}

    // Decides about a new connection, which is idle.
    Decision Arrive(const Address &from);
    // For a connection that was accepted and not dropped; otherwise these do nothing.
    void BecomesIdle(Id id);
    void BecomesBusy(Id id);
    void OpensPage(Id id);
    void Leaves(Id id) { _open.erase(id); }

    std::size_t Open() const { return _open.size(); }

private:
    struct Connection
    {
        Address From;
        std::uint64_t IdleSince = 0;  // a rising number; 0: not idle
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
