#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitEvent.h>
#include <rabit/gateway/Claims.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agreement/AgreementNode.h"
#include "agreement/TableCopy.h"

namespace Rabit
{

// The part of an agreement that the program's threads share with the gateway's thread: the member of the
// agreement, which both call, and the table. So no call of the program waits for a disk or for the network.
//
// Thread-safe. No mutex is held while a file is written or a handler is called. Claims do not wait for the
// table, which has a mutex of its own.
class AgreementHub
{
public:
    using Duration = std::chrono::nanoseconds;

    // For Claims. Without a gateway, a claim that is asked for waits for one.
    bool Want(const std::string &claim, bool keeps);
    void GiveUp(const std::string &claim);
    std::optional<std::uint64_t> FenceOf(std::string_view claim) const;
    std::vector<std::string> Mine() const;
    Claims::Status StatusOf(std::string_view claim) const;

    // For SharedTable. Calls change(table), and tells the change. Returns why it was refused; empty: it is
    // done.
    std::string_view Write(const std::function<std::string_view(TableCopy &)> &change);
    // The value of a key; empty: it is not known.
    std::optional<TableValue> ValueOf(std::string_view key) const;
    std::vector<std::string> Keys() const;

    RabitEvent &ClaimsChanged() { return _claimsChanged; }
    RabitEvent &TableChanged() { return _tableChanged; }

    // For the gateway's thread. The member begins with these settings and fences, and with the claims that
    // are asked for already. The clock and the references of `random` and `wake` must be good until Close.
    // Returns false if another gateway serves this object.
    bool Open(const AgreementSettings &settings, std::uint64_t fences, const RabitClock &clock,
              std::function<std::uint64_t()> random, std::function<void()> wake);
    // Gives up all claims, and returns the datagrams that tell the others so. The table is empty from then
    // on. Claims that are kept wait for the next gateway. Calls no handler: TellClaims does. Without effect
    // if no gateway serves this object.
    std::vector<AgreementNode::Datagram> Close();

    // Calls use(node, now) with the mutex held, and with the time that the clock shows then: a thread that
    // waited for the mutex must not use an earlier one. The node must not be kept. Only between Open and
    // Close.
    template <typename Use>
    auto With(const Use &use)
    {
        const std::lock_guard lock(_mutex);
        const TakesEvents taken(*this);
        return use(*_node, _clock->Monotonic());
    }
    // The same with the table, whose mutex is another one.
    template <typename Use>
    auto WithTable(const Use &use)
    {
        const std::lock_guard lock(_tableMutex);
        return use(*_table);
    }
    // The claims that were won, lost or refused since the last call.
    std::vector<OwnClaims::Event> TakeEvents();
    // Tell the program that a claim has changed, and that the table has if it did since the last call.
    void TellClaims() { _claimsChanged.Fire(); }
    void TellTable();

private:
    // Takes the events of the node at the end of a use, so that none is taken for one of a later attempt.
    struct TakesEvents
    {
        explicit TakesEvents(AgreementHub &hub) : Hub(hub) {}
        ~TakesEvents() { Hub.TakeEventsOfNode(); }
        TakesEvents(const TakesEvents &) = delete;
        TakesEvents &operator=(const TakesEvents &) = delete;
        AgreementHub &Hub;
    };

    bool WantWithoutGateway(const std::string &claim, bool keeps);
    // With the mutex.
    void TakeEventsOfNode();
    void Wake() const;

    mutable std::mutex _mutex;
    std::optional<AgreementNode> _node;    // empty: no gateway serves this object
    const RabitClock *_clock = nullptr;    // null likewise
    std::function<void()> _wake;           // empty likewise
    std::string _name;                     // of the node
    std::map<std::string, bool> _waiting;  // claims that wait for a gateway, and whether they are kept
    std::map<std::string, std::string, std::less<>> _reasons;  // of claims that were not won, or were lost
    std::vector<OwnClaims::Event> _events;

    mutable std::mutex _tableMutex;
    std::optional<TableCopy> _table;
    RabitEvent _claimsChanged;
    RabitEvent _tableChanged;
};

}  // namespace Rabit
