#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/RecentGoodbyes.h"
#include "common/RecentMap.h"
#include "guard/Claim.h"
#include "guard/DiscoveryFragments.h"
#include "rtps/CardExchange.h"
#include "rtps/CardReplay.h"
#include "rtps/OwnCard.h"

namespace Rabit::Rtps
{

// Lets nodes find each other by cards (PackedCard.h), in place of the endpoint discovery of DDS.
//
// It stands between the own DDS implementation and the network. `OwnCard` gathers the implementation's
// announcements, `CardExchange` brings them to other nodes, and `CardReplay` tells the implementation the
// content of other nodes' cards. Programs without a card get the implementation's own datagrams.
//
// A silent participant is remembered for Settings::Memory. If another participant of the same name has
// appeared since, the silent one is ended (CardReplay::End).
//
// Anybody can send cards of participants that do not exist. Until a participant has spoken (Ledger.h) it is a
// stranger. Of too many strangers, those of the host that has most are ended, the oldest first.
//
// A pure state machine, not thread-safe.
class Meeting
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = Backoff::Duration;

    struct Settings
    {
        Duration Period{0};       // interval of the own card's summary
        Duration Memory{0};       // how long a silent participant is remembered
        bool IsMulticast = true;  // card messages go to all (CardExchange::Settings)
    };

    // Own announcements within this time are packed together.
    static constexpr std::chrono::milliseconds Hold{10};
    // After this time, programs without a card that do not announce themselves any more are forgotten.
    static constexpr std::chrono::minutes ProgramsForgotten{5};
    static constexpr std::size_t MostRemembered = 1024;
    // If more participants with cards are known, those that are silent for longest are ended.
    static constexpr std::size_t MostSilent = 256;
    // Strangers, and bytes of all their cards.
    static constexpr std::size_t MostStrangers = 256;
    static constexpr std::size_t MostOfStrangers = 4 * 1024 * 1024;

    explicit Meeting(const Settings &settings)
        : _settings(settings),
          _exchange({.Period = settings.Period, .IsMulticast = settings.IsMulticast}),
          _replay(settings.Memory)
    {
    }

    // The own participant. Without multicast it asks others for their cards before it sends anything itself.
    void SetSelf(const GuidPrefix &self);
    bool IsSelf(const GuidPrefix &participant) const { return participant == _self; }
    // The own implementation is about to send this datagram, which has no samples. Returns true if it should
    // not be sent: all its addressees have cards.
    bool Sending(std::span<const std::uint8_t> datagram, TimePoint now);
    // Takes a datagram that IsCardMessage. `isKnownAt`: its sender has announced that address. Returns false
    // if it is unsound, or not from its sender's address.
    bool Received(std::span<const std::uint8_t> datagram, const HostAddress &from, bool isKnownAt,
                  TimePoint now);

    // A datagram came from a participant that the implementation does not know.
    void HeardUnknown(const GuidPrefix &peer, TimePoint now);
    // A participant announced itself on the network.
    void Announced(const GuidPrefix &peer, bool hasCard, TimePoint now);
    // A participant said goodbye. It is ignored until it is known to go on (RecentGoodbyes.h).
    void SaidGoodbye(const GuidPrefix &peer, TimePoint now);
    // An endpoint of the participant has spoken.
    void Spoke(const GuidPrefix &peer);
    // The implementation has lost a participant.
    void Lost(const GuidPrefix &peer);
    // True if the implementation learns of that participant here. Endpoint discovery in the participant's
    // name from the network must then be ignored.
    bool IsReplayed(const GuidPrefix &peer) const { return _replay.Has(peer); }

    // The own endpoints, and those of them that the card holds.
    struct Told
    {
        std::size_t Endpoints = 0;
        std::size_t InCard = 0;
    };
    // Empty unless the card is too small for all endpoints. Other nodes do not learn of those beyond.
    std::optional<Told> CardIsFull() const;

    // For the own implementation.
    struct Local
    {
        HostAddress From{};
        std::vector<std::uint8_t> Bytes;
    };
    std::optional<TimePoint> LocalDue() const;
    std::vector<Local> TakeLocal(TimePoint now);
    // For the network, one message at a time (CardExchange).
    std::optional<TimePoint> NetworkDue() const { return _exchange.Due(); }
    std::size_t NetworkBytes(TimePoint now) const { return _exchange.DueBytes(now); }
    std::optional<CardExchange::Outgoing> TakeForNetwork(TimePoint now) { return _exchange.TakeDue(now); }
    // CardExchange::Delay
    CardExchange::Duration QueueingDelay(TimePoint now) const { return _exchange.Delay(now); }
    // Participants to be ended once they are silent for EndAfter(): former sessions of nodes that have
    // another one, and all if there are more than MostSilent.
    std::vector<GuidPrefix> Endable() const;
    bool AnyEndable() const { return _replay.Size() > MostSilent || !_superseded.empty(); }
    // Two and a half periods: a living participant has announced itself twice.
    Duration EndAfter() const { return 5 * _settings.Period / 2; }
    void End(const GuidPrefix &peer);
    // True if it was ended here, and did not say goodbye.
    bool WasEnded(const GuidPrefix &peer) const { return _ended.Find(peer) != nullptr; }

private:
    void Pack(TimePoint now);
    bool IsThere(const GuidPrefix &peer, const HostAddress &from);
    bool IsForPrograms(const GuidPrefix &to, TimePoint now);
    void Say(const EndpointSubmessage &said, std::span<const std::uint8_t> header, TimePoint now);
    void NoteSuccessor(const GuidPrefix &peer);
    void NoteStranger(const GuidPrefix &peer, const HostAddress &from, bool isNew);

    const Settings _settings;
    GuidPrefix _self{};
    OwnCard _own;
    CardExchange _exchange;
    CardReplay _replay;
    DiscoveryFragments _fragments;  // of the own implementation's announcements
    std::optional<TimePoint> _packAt;
    Told _told;
    std::map<GuidPrefix, Claim<HostAddress>> _places;  // source addresses of their card messages
    std::map<GuidPrefix, TimePoint> _programs;         // without a card: when each was last announced
    std::map<GuidPrefix, std::string> _superseded;
    struct Stranger
    {
        HostAddress Host{};
        std::size_t Bytes = 0;
        std::uint64_t Turn = 0;  // rises with each
    };
    std::map<GuidPrefix, Stranger> _strangers;
    std::size_t _bytesOfStrangers = 0;
    std::uint64_t _turn = 0;
    RecentGoodbyes _goodbyes;
    RecentMap<GuidPrefix, std::monostate> _ended{64};
};

}  // namespace Rabit::Rtps
