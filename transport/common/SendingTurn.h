#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace Rabit
{

// A datagram that will be sent at the end of a turn.
class TurnDatagram
{
public:
    virtual ~TurnDatagram() = default;
    // Adds a datagram of the same way, so that both go as one. Returns the bytes that it adds; 0: it was not
    // added.
    virtual std::size_t Add(std::span<const std::uint8_t> datagram) = 0;
    virtual void Send() = 0;
};

// The turn of a session (TransportSession::BeginTurn). Between Begin and End, the backend's output passes
// each datagram of samples that this thread sends to Take, in place of sending it.
//
// Only one thread uses turns, and only that thread calls the functions; IsOfThisThread may be called by any.
class SendingTurn
{
public:
    // Equal for datagrams from one socket to one address and port.
    using Way = std::pair<std::uint64_t, std::uint64_t>;

    // The datagrams and bytes that one more datagram adds.
    struct Grown
    {
        std::size_t Datagrams = 0;  // 1, or 0 if it joined a datagram
        std::size_t Bytes = 0;      // without the headers of IP and UDP
    };

    SendingTurn() = default;
    // On the thread of the turn, if there is one.
    ~SendingTurn() { Drop(); }
    SendingTurn(const SendingTurn &) = delete;
    SendingTurn &operator=(const SendingTurn &) = delete;

    // True if the datagrams that the calling thread sends belong to this turn.
    bool IsOfThisThread() const { return _ofThread == this; }
    // Returns false, and begins nothing, if this thread is in a turn already, of another session. `most`:
    // largest datagram made of several, in bytes without the headers of IP and UDP.
    bool Begin(std::size_t most);
    // Keeps the datagram: it joins the last one of the same way, or follows it. `make(most)` returns an empty
    // TurnDatagram, which must accept a first datagram of any size.
    template <typename Make>
    Grown Take(const Way &way, std::span<const std::uint8_t> datagram, const Make &make)
    {
        Note(way);
        TurnDatagram *const last = LastOf(way);
        if (const std::size_t grown = last != nullptr ? last->Add(datagram) : 0; grown > 0)
        {
            return {0, grown};
        }
        _kept.emplace_back(way, make(_most));
        return {1, _kept.back().second->Add(datagram)};
    }
    // TransportSession::TakeTurnDestinations
    TurnDestinations TakeDestinations() { return std::exchange(_taken, {}); }
    // Ends the turn, and sends what was kept, in its order.
    void End();
    // Ends the turn, and forgets what was kept.
    void Drop();

private:
    void Note(const Way &way);
    TurnDatagram *LastOf(const Way &way);

    static inline thread_local SendingTurn *_ofThread = nullptr;

    std::size_t _most = 0;
    TurnDestinations _taken;
    std::vector<std::pair<Way, std::unique_ptr<TurnDatagram>>> _kept;
};

}  // namespace Rabit
