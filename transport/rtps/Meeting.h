#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "guard/DiscoveryFragments.h"
#include "rtps/CardExchange.h"
#include "rtps/CardReplay.h"
#include "rtps/OwnCard.h"

namespace Rabit::Rtps
{

// How a node and other nodes find each other: by cards (PackedCard.h) in place of the endpoint discovery of
// DDS.
//
// It stands between the own DDS implementation and the network. `OwnCard` gathers what the implementation
// wants to say of its endpoints, `CardExchange` brings it to other nodes, and `CardReplay` tells the
// implementation what the other nodes' cards say. Programs without a card get the implementation's own
// datagrams.
//
// A participant is remembered for as long as Settings::Memory, however silent it is. When a participant of
// the same name has appeared since, and it is silent, it is ended (CardReplay::End).
//
// A pure state machine, not thread-safe.
class Meeting
{
public:
    using TimePoint = Backoff::TimePoint;
    using Duration = Backoff::Duration;

    struct Settings
    {
        Duration Period{0};       // in which the own card's summary is said again
        Duration Memory{0};       // how long a silent participant is remembered
        bool IsMulticast = true;  // whether card messages go to all (CardExchange::Settings)
    };

    // The own announcements come together.
    static constexpr std::chrono::milliseconds Hold{10};
    // The source address of a participant's card messages may change: another one is believed when so many
    // messages in a row came from there.
    static constexpr int OftenEnough = 3;
    // Of programs without a card that do not announce themselves any more.
    static constexpr std::chrono::minutes ProgramsForgotten{5};
    static constexpr std::size_t MostRemembered = 1024;
    // Of more participants with cards than this the ones that are silent for longest are ended.
    static constexpr std::size_t MostSilent = 256;

    explicit Meeting(const Settings &settings)
        : _settings(settings),
          _exchange({.Period = settings.Period, .IsMulticast = settings.IsMulticast}),
          _replay(settings.Memory)
    {
    }

    // The own implementation is about to send this datagram, which has no samples. True if it is not to go:
    // all whom it is for have cards.
    bool Sending(std::span<const std::uint8_t> datagram, TimePoint now);
    // A datagram that IsCardMessage. `isKnownAt`: its sender has said that it is at that address. Returns
    // false if it is not sound, or not from where its sender is.
    bool Received(std::span<const std::uint8_t> datagram, const HostAddress &from, bool isKnownAt,
                  TimePoint now);

    // A datagram came of a participant that the implementation does not know.
    void HeardUnknown(const GuidPrefix &peer, TimePoint now);
    // A participant announced itself on the network.
    void Announced(const GuidPrefix &peer, bool hasCard, TimePoint now);
    // A participant said goodbye; or the implementation has lost it.
    void Gone(const GuidPrefix &peer, bool forGood);
    // Whether the implementation is told of that participant here. Endpoint discovery in the participant's
    // name from the network is to be ignored then.
    bool IsReplayed(const GuidPrefix &peer) const { return _replay.Has(peer); }

    void SetRate(double bytesPerSecond) { _exchange.SetRate(bytesPerSecond); }

    std::optional<TimePoint> Due() const;
    struct Work
    {
        std::vector<CardExchange::Outgoing> ToNetwork;
        struct Local
        {
            HostAddress From{};
            std::vector<std::uint8_t> Bytes;
        };
        std::vector<Local> ToImplementation;
    };
    Work TakeDue(TimePoint now);
    // Participants to be ended once they are silent for EndAfter(): former sessions of nodes that have
    // another one, and all if there are more than MostSilent.
    std::vector<GuidPrefix> Endable() const;
    // Two periods and a half: who lives has announced itself twice.
    Duration EndAfter() const { return 5 * _settings.Period / 2; }
    void End(const GuidPrefix &peer);
    // Whether it was ended here, and did not say goodbye.
    bool WasEnded(const GuidPrefix &peer) const;

private:
    // Where a participant's card messages come from.
    struct Place
    {
        HostAddress From{};
        HostAddress Other{};
        int Times = 0;
    };

    static void Remember(std::deque<GuidPrefix> &peers, const GuidPrefix &peer);
    bool IsThere(const GuidPrefix &peer, const HostAddress &from);
    bool IsForPrograms(const GuidPrefix &to, TimePoint now);
    void Say(const EndpointSubmessage &said, std::span<const std::uint8_t> header, TimePoint now);
    void NoteSuccessor(const GuidPrefix &peer);

    const Settings _settings;
    GuidPrefix _self{};
    OwnCard _own;
    CardExchange _exchange;
    CardReplay _replay;
    DiscoveryFragments _fragments;  // of the own implementation
    std::optional<TimePoint> _packAt;
    std::map<GuidPrefix, Place> _places;
    std::map<GuidPrefix, TimePoint> _programs;  // without a card; when each was announced last
    std::map<GuidPrefix, std::string> _superseded;
    std::deque<GuidPrefix> _gone;   // the last that said goodbye
    std::deque<GuidPrefix> _ended;  // the last that were ended here
};

}  // namespace Rabit::Rtps
