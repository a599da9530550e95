#pragma once

#include <rabit/simulated/SimulatedNetwork.h>
#include <rabit/transport/Transport.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "EventQueue.h"
#include "FaultPlan.h"
#include "MediumPlan.h"
#include "Random.h"
#include "World.h"

namespace Rabit::Simulated
{

using Time = std::chrono::nanoseconds;
using ParticipantPtr = std::shared_ptr<ParticipantState>;
using WriterPtr = std::shared_ptr<WriterState>;
using ReaderPtr = std::shared_ptr<ReaderState>;

// The simulation behind SimulatedNetwork and the sessions on it. Thread-safe.
//
// One mutex guards all state. Calls that leave the simulation (handlers, log lines) are collected while it is
// held, and made after it is released.
class NetworkCore
{
public:
    NetworkCore(std::uint64_t seed, const SimulatedTimings &timings) : _timings(timings), _random(seed) {}

    // For SimulatedNetwork.
    void SetFaults(const std::string &from, const std::string &to, const SimulatedFaults &faults);
    void ClearFaults();
    void SetMedium(const std::string &nodes, const SimulatedMedium &medium);
    SimulatedAir Air(const std::string &nodes) const;
    SimulatedSent Sent(const std::string &node) const;
    Time Now() const;
    std::optional<Time> NextEvent() const;
    void AdvanceTo(Time time);
    void CrashNode(const std::string &node);
    SimulatedTraffic Traffic() const;

    // For SimulatedKeys: a clock that shows CardTime() and takes no lock, since seals ask members for
    // problems and bulletins while it is held. It may outlive this.
    std::function<Rtps::CardExchange::TimePoint()> ClockOfMembers() const;

    // For sessions.
    ParticipantPtr Join(const TransportSettings &settings, PeerHandler onPeer);
    void Leave(ParticipantState &participant);
    WriterPtr AddWriter(const ParticipantPtr &participant, const TopicDescription &topic, const TopicQos &qos,
                        const std::vector<std::string> &partitions);
    ReaderPtr AddReader(const ParticipantPtr &participant, const TopicDescription &topic, const TopicQos &qos,
                        const std::vector<std::string> &partitions, SampleHandler handler);
    void RemoveWriter(ParticipantState &participant, const WriterState &writer);
    void RemoveReader(ParticipantState &participant, const ReaderState &reader);
    // Gives the sample its sequence number and sends it, to the readers of `node` alone if it is given.
    // Returns false if the session is gone.
    bool Write(ParticipantState &participant, WriterState &writer, const std::shared_ptr<Sample> &sample,
               const std::string *node = nullptr, std::uint32_t partsBefore = 0);
    // Sends the next datagram of a sample that takes several, except its last, which Write sends
    // (`partsBefore`: number of datagrams sent earlier). Returns false if the session is gone.
    bool WritePart(const ParticipantState &participant, const WriterState &writer, const Sample &sample);
    // Bytes of one such datagram on the air, to all destinations.
    std::size_t BytesOfPart(const ParticipantState &participant, const WriterState &writer,
                            const Sample &sample) const;
    // TransportSession::BeginTurn, TakeTurnDestinations, EndTurn
    bool BeginTurn(ParticipantState &participant, std::size_t most);
    TurnDestinations TakeTurnDestinations(ParticipantState &participant);
    void EndTurn(ParticipantState &participant);
    int MatchedReaders(const WriterState &writer) const;
    // The most bytes that a seal adds to a packet; 0 without a member.
    static std::size_t MostOfSeal(const ParticipantState &participant);
    // DiscoveryTurns::Exchange of that participant.
    std::size_t NextDiscoveryBytes(ParticipantState &participant);
    void SendNextDiscovery(const ParticipantPtr &participant);
    Time CardDelay(const ParticipantState &participant) const;
    int Destinations(const ParticipantState &participant, const WriterState &writer) const;
    int MatchedWriters(const ReaderState &reader) const;
    std::optional<Time> LastArrival(const std::string &from, const std::string &to,
                                    const std::string &topic) const;

private:
    // Cost of data that is sent together, in packets of one size.
    struct Cost
    {
        std::uint32_t Packets = 1;
        std::uint64_t Bytes = 0;  // of each packet, on the air
        bool IsDiscovery = false;
    };
    struct Event
    {
        enum class Kind
        {
            Arrival,
            AnnouncementTimer,
            CardTimer,
            SealTimer,
            LeaseTimer,
            HeartbeatTimer,
            Passage  // the packet on the air of medium number At has passed
        };
        Kind What = Kind::Arrival;
        ParticipantId At = 0;     // where it happens
        ParticipantId Other = 0;  // the sender of an arrival, or the peer of the timer
        std::uint64_t Birth = 0;  // of that peer's entry; or the number of another timer
        Datagram Content;         // of an arrival; the heartbeat timer uses its Writer
    };
    using Calls = std::vector<std::function<void()>>;

    // NetworkCore.cpp
    void Handle(Event event);
    void Arrive(const ParticipantPtr &at, ParticipantId from, const Datagram &datagram);
    // Sets _now, unless it is later already.
    void Reach(Time time);
    void Later(Time delay, Event event) { _events.Push(_now + delay, std::move(event)); }
    void RunCalls(std::unique_lock<std::mutex> &lock);

    // Sending.cpp
    void Send(const ParticipantState &from, ParticipantId to, Datagram datagram, Time processing = Time(0));
    void SendToGroup(const ParticipantState &from, Letters letters, const Datagram &content);
    // `partsBefore`: datagrams of each letter that were sent earlier, and are not counted again.
    void SendTogether(const ParticipantState &from, Letters letters, bool multicast,
                      std::uint32_t partsBefore = 0);
    void SendAlone(const ParticipantState &from, Letter letter);

    // SendingTurn.cpp
    void Keep(ParticipantState &from, Letters letters, bool multicast);
    void KeepPacket(ParticipantState &from, ParticipantId to, Letters letters);
    void SendKept(ParticipantState &from);
    void SendPacket(const ParticipantState &from, Letters letters);
    void Transmit(const SimulatedFaults &faults, ParticipantId from, ParticipantId to, Datagram datagram,
                  Time processing);

    // Air.cpp
    void Offer(Medium &medium, const std::shared_ptr<Flight> &flight, const Cost &cost);
    void AwaitPassage(const Medium &medium);
    void OnPassage(Medium &medium);
    void Land(Flight &flight);

    // Discovery.cpp
    // Sends to all participants of the domain, or to one.
    void SendDiscovery(const ParticipantState &from, ParticipantId to, const Datagram &content);
    void Announce(const ParticipantPtr &participant);
    void HearAnnouncement(const ParticipantPtr &me, ParticipantId from);
    Peer &MeetPeer(const ParticipantPtr &me, ParticipantId from, const ParticipantState &sender);
    void EndFormerLives(const ParticipantPtr &me, const Peer &successor);
    void CheckLease(const ParticipantPtr &me, ParticipantId peer, std::uint64_t birth);
    void LosePeer(const ParticipantPtr &me, ParticipantId peer, PeerEvent::Kind how);
    void TellPeerEvent(const ParticipantPtr &me, const Peer &peer, PeerEvent::Kind what);

    // Endpoints.cpp
    void EndpointsChanged(ParticipantState &me, EndpointInfoPtr added, const EndpointId &removed);
    void TakeEndpoints(const ParticipantPtr &me, Peer &peer,
                       const std::shared_ptr<const EndpointList> &endpoints);

    // Cards.cpp
    Rtps::CardExchange::TimePoint CardTime() const { return CardTimeOf(_now); }
    static Rtps::CardExchange::TimePoint CardTimeOf(Time now);
    // Sets the timer for what is due then, unless it is set for an earlier time.
    void Await(DueTimer &timer, Event::Kind kind, ParticipantId at,
               std::optional<Rtps::CardExchange::TimePoint> due);
    void AwaitCards(ParticipantState &me);
    void ServeCards(const ParticipantPtr &me);
    // Sends one message of the exchange of cards. Returns false if none is due.
    bool SendCard(const ParticipantPtr &me);
    void HearCard(const ParticipantPtr &me, ParticipantId from, const Datagram &datagram);
    void HearUnknown(ParticipantState &me, ParticipantId from, const Datagram &datagram);

    // Sealing.cpp
    // Seals each letter by itself, although they go in one packet. Returns the bytes that a seal adds to the
    // packet; 0 without a member.
    std::uint64_t SealLetters(const ParticipantState &from, Letters::iterator first, Letters::iterator last,
                              bool multicast) const;
    // The bytes that a seal adds to a packet of which no receiver learns.
    static std::uint64_t SealOfPart(const ParticipantState &from);
    // True if the datagram may be read: the seal opens, or neither side has a member.
    bool Opens(ParticipantState &at, ParticipantId from, const Datagram &datagram);
    void AwaitSeal(ParticipantState &me);
    void ServeSeal(const ParticipantPtr &me);
    // Sends one datagram that introduces the participant. Returns false if none is due.
    bool SendIntroduction(const ParticipantPtr &me);
    // Its bytes; 0: none is due.
    std::size_t IntroductionBytes(ParticipantState &me);
    // True if the sender's certificate has the sender's name.
    static bool MayMeet(const ParticipantState &me, ParticipantId from, const ParticipantState &sender);
    // Those endpoints that the sender's certificate allows.
    static std::shared_ptr<const EndpointList> AllowedOf(const ParticipantState &me, ParticipantId from,
                                                         const std::shared_ptr<const EndpointList> &all);

    // Matching.cpp
    void EndpointAppeared(const ParticipantPtr &me, const Peer &peer, const EndpointInfo &remote);
    void EndpointGone(const ParticipantPtr &me, const EndpointId &remote);
    bool Fits(const ParticipantPtr &me, const EndpointInfo &writer, const EndpointInfo &reader);
    void MatchReader(const ParticipantPtr &me, WriterState &writer, const EndpointInfo &remote);
    void MatchWriter(const ParticipantPtr &me, const Peer &peer, ReaderState &reader,
                     const EndpointInfo &remote);
    void UnmatchWriter(const ReaderPtr &reader, std::map<EndpointId, WriterProxy>::iterator proxy);

    // Traffic.cpp: counts datagrams by their sizes in RTPS.
    static std::uint64_t CountDestinations(const ParticipantState &me, const WriterState &writer);
    static Cost CostOfPart(const Sample &sample);
    static Cost CostOf(const ParticipantState &me, const Datagram &datagram);
    void Count(const ParticipantState &me, const Cost &cost);

    // WriterSide.cpp
    static Datagram MakeData(const WriterState &writer, const EndpointId &to, const ReaderProxy &reader,
                             const SamplePtr &sample);
    static std::uint32_t *MissingOf(const ParticipantState &me, const Datagram &datagram);
    static void NoteFragments(const ParticipantState &me, const Datagram &datagram, std::uint32_t lost);
    static bool WaitsForHeartbeat(const WriterState &writer);
    void AwaitHeartbeat(WriterState &writer, Time delay);
    void SendHeartbeats(const ParticipantState &me, WriterState &writer);
    void HearAcknowledgement(const ParticipantState &me, WriterState &writer, const Datagram &datagram);

    // ReaderSide.cpp
    void HearSample(const ParticipantPtr &me, const ReaderPtr &reader, const Datagram &datagram);
    void HearHeartbeat(const ParticipantPtr &me, const ReaderPtr &reader, const Datagram &datagram);
    void SkipTo(const ParticipantPtr &me, const ReaderPtr &reader, const EndpointId &from,
                WriterProxy &writer, std::uint64_t first);
    void HandOverInOrder(const ReaderPtr &reader, const EndpointId &from, WriterProxy &writer);
    void HandOver(const ReaderPtr &reader, const EndpointId &from, const WriterProxy &writer,
                  const SamplePtr &sample);

    const SimulatedTimings _timings;
    std::mutex _stepping;  // held by the one thread that advances the time
    const std::shared_ptr<std::atomic<Time::rep>> _shown =
        std::make_shared<std::atomic<Time::rep>>(0);  // _now
    mutable std::mutex _mutex;
    // All below are guarded by _mutex.
    Random _random;
    Time _now{0};
    EventQueue<Event> _events;
    FaultPlan _faults;
    MediumPlan _media;
    std::vector<SimulatedSent> _sent;  // by node number
    SimulatedTraffic _traffic;
    std::map<ParticipantId, ParticipantPtr> _participants;
    ParticipantId _lastParticipant = 0;
    std::uint64_t _lastBirth = 0;
    Calls _calls;
};

}  // namespace Rabit::Simulated
