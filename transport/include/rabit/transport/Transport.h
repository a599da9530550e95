// The interface between Rabit and a network ("the cut").
//
// A backend implements the abstract classes below and nothing else; the gateway uses them and nothing else.
// Bytes cross the cut, never message classes and never a vendor's types. One conformance suite
// (tests/transport) checks every backend against the contract written here.
//
// Threads
//   Every method may be called from any thread, except from inside a handler (see below).
//   Handlers run on a thread of the backend. Two handlers of one reader never run at once; handlers of
//   different readers may. A handler must be quick, must not block, and must not throw (what it throws is
//   caught, counted and logged). It must not call back into the transport: signal another thread instead.
//
// Lifetime
//   A session owns its participant in the network. Writers and readers belong to their session and must be
//   destroyed before it. Destroying a reader (or closing the session) returns only when no handler of it runs
//   any more; none starts afterwards.
//
// Changes of the network
//   A session may be opened before there is a network. A real backend follows the host's networks by itself.
//   A network that vanishes and returns unchanged needs no action: peers are Lost and appear again. If a
//   usable network or address comes that the session was not opened with, the backend joins the network anew
//   and logs it. All peers are then Lost and appear again, and readers get transient-local history once more.
//   Writers start with an empty history, a new WriterId and new numbers. The backend also joins anew, without
//   the network that is gone, if a peer might go on sending there. It joins anew for loopback if no other
//   network is left. It does so rarely: an interface that comes and goes is joined later each time, and never
//   twice in a second. During the change, and as long as there is no usable network, writes end TimedOut at
//   once and nothing is matched. Making or destroying a writer or reader waits for the end of the change:
//   milliseconds to tenths of a second.
//
//   A network is usable if its interface is up and has a carrier and an IPv4 address. If no interface is
//   named, a network must also be capable of multicast, unless multicast is off or Peers are listed; loopback
//   then counts only if no other network is usable. A network or peer that the settings name and that is
//   missing is waited for, and NetworkProblems reports it. Processes that were stopped, or heard nothing, for
//   longer than the lease find each other again, whichever side had lost the other: Lost peers appear again,
//   and endpoints match again.
//
// Errors
//   Opening something with impossible settings throws TransportError with one clear line. Failures of normal
//   operation are return values. Nothing that arrives from the network throws or ends the process.
#pragma once

#include <rabit/transport/DiscoveryTurns.h>
#include <array>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace Rabit
{

class FleetMember;

// Settings that a backend cannot honour: an unparsable peer, a bad configuration file, an exhausted domain.
class TransportError : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
    // `setting` is the setting at fault, as a configuration file calls it: `interfaces`, `peers`,
    // `backend_config` ...
    TransportError(const std::string &message, std::string setting)
        : std::runtime_error(message), _setting(std::move(setting))
    {
    }
    // Empty if no single setting is at fault.
    const std::string &Setting() const { return _setting; }

private:
    std::string _setting;
};

// Settings common to all backends.
struct TransportSettings
{
    // Unique name of this node, 1 to 200 bytes of UTF-8. Becomes the participant's name.
    std::string Node;
    // Incarnation: differs for each start of the node. Peers see it in SampleInfo and PeerEvent.
    std::uint64_t Incarnation = 0;
    // DDS domain, 0 to 232.
    int Domain = 0;
    // Network interfaces to use, by name or address; empty: all usable ones. A missing interface is waited
    // for.
    std::vector<std::string> Interfaces;
    // Addresses of peers for unicast discovery, `host` or `host:port`; empty: discovery by multicast alone. A
    // host may be a name; a name without an address is looked up until it has one.
    std::vector<std::string> Peers;
    // True if multicast may be used, for discovery and for samples with more than one reader. If Peers are
    // listed, multicast serves discovery alone: it may not reach all of them.
    bool Multicast = true;
    // The range of MaxDatagram.
    static constexpr std::size_t SmallestDatagram = 1000;
    static constexpr std::size_t LargestDatagram = 65000;
    // Largest datagram to send, 1000 to 65000 bytes; larger ones are received all the same. The default stays
    // below the MTU of radios: if one IP fragment of a larger datagram is lost, the whole datagram is. Use
    // 65000 on loopback and wired networks.
    std::size_t MaxDatagram = 1400;
    // Use shared memory between processes of one host. Off by default: a killed process leaves files behind.
    bool SharedMemory = false;
    // A peer that sends nothing for the length of the lease, at most 5 min, is lost. A session announces
    // itself at least once per AnnouncementPeriod, more often at first and to peers that have not heard it.
    // The period costs an idle node some 400 bytes each time. It also bounds how long nodes take to find each
    // other again after a separation longer than the lease.
    std::chrono::milliseconds Lease{30000};
    std::chrono::milliseconds AnnouncementPeriod{10000};
    // A silent Rabit node is remembered for this long, so that discovery need not be repeated when it is
    // back. Without multicast it is remembered for the length of the lease alone.
    // Another session of the same node ends the former one once the former has been silent for some seconds.
    std::chrono::milliseconds Memory{std::chrono::hours(4)};
    // A vendor's own configuration file, for the expert; empty: none.
    std::string BackendConfig;
    // This node's membership of a fleet with keys (FleetMember.h); null: none. Only members of the same fleet
    // are heard and answered, within their permissions. One object serves all sessions of the node. A backend
    // that cannot seal each datagram with these settings throws TransportError.
    std::shared_ptr<FleetMember> Member{};
    // Takes the session's log lines (handlers that threw, writes that failed, types that differ ...), without
    // a newline. Called on any thread; must be quick and thread-safe. If not set, only the counters tell.
    std::function<void(const std::string &)> Log;
};

// A setting that is wrong on this host now.
struct SettingsProblem
{
    std::string Setting;  // as a configuration file calls it: `interfaces`, `peers`, `backend_config` ...
    std::string Entry;    // the interface or peer at fault; empty if Setting has no entries
    std::string Text;     // one line for people, names the entry
    // True if opening a session throws for it. If false, the session waits for the missing thing and works
    // without.
    bool Impossible = false;
};

enum class Reliability
{
    BestEffort,
    Reliable
};

enum class Durability
{
    Volatile,       // a reader gets what is written while it is matched
    TransientLocal  // a late reader also gets the writer's history; a reader that had lost the writer may get
                    // it again
};

// Largest sample that every backend can send, in bytes, the encapsulation header included. Larger ones are
// neither sent nor accepted, which bounds a reader's allocations.
inline constexpr std::size_t LargestSample = std::size_t{64} << 20;

// Quality of service of a writer or reader, in the terms of the OMG DDS specification, section 2.2.3.
// The history is always keep-last: a slow reader never blocks a writer for ever.
struct TopicQos
{
    Rabit::Reliability Reliability = Rabit::Reliability::Reliable;
    Rabit::Durability Durability = Rabit::Durability::Volatile;
    // Samples kept by the writer for repair and for late readers (for each key if the topic is keyed). A
    // volatile writer drops a sample earlier, once all matched readers have acknowledged it (best-effort
    // ones: once it is sent), at the latest with the next write. So it holds only samples in transit, and
    // none while no reader is matched. A transient-local writer keeps a sample until another pushes it out or
    // its instance is disposed. A reader delivers each sample on arrival and keeps only the keys of living
    // instances: samples of one writer never push out those of another, keyed topic or not.
    int Depth = 1;
};

// 16 bytes that name an instance of a keyed topic, computed as in the OMG DDSI-RTPS specification, 9.6.3.8.
using KeyHash = std::array<std::uint8_t, 16>;

// A sample as on the wire: the 4-byte encapsulation header, then XCDR1. The two low bits of the header's last
// byte may be set in transit: the number of padding bytes that RTPS added (OMG DDS-XTypes 1.3, 7.6.3.1.2).
// The padding is not part of the bytes delivered. A writer of another make that does not set these bits may
// leave up to three zero bytes at the end.
using SampleBytes = std::span<const std::uint8_t>;

// Name and types of a topic. Writer and reader match if Name and TypeName are equal and QoS and partitions
// fit.
struct TopicDescription
{
    std::string Name;      // for instance `Pose`
    std::string TypeName;  // the IDL name, for instance `Uav::Pose`
    // Set if and only if the type has a key. Computes the key hash of a sample; returns false if the bytes do
    // not decode. Called on any thread, on several at once too; must not throw.
    std::function<bool(SampleBytes, KeyHash &)> KeyOf;
    // The hash of the type in ROS 2 (REP-2011), which writers and readers announce for programs of ROS 2;
    // empty: none. Matches do not depend on it.
    std::string TypeHash{};
};

// 16 bytes that identify one writer in the network (an RTPS GUID), different for each writer.
using WriterId = std::array<std::uint8_t, 16>;

// Metadata of a sample. Valid only during the handler's call.
struct SampleInfo
{
    WriterId Writer{};
    // Name of the writer's node; empty if the writer is not a Rabit node (a plain DDS program).
    std::string_view Node;
    // Incarnation of that node; 0 if the writer is not a Rabit node.
    std::uint64_t Incarnation = 0;
    // Time of the write by the writer's clock, in nanoseconds since 1970-01-01 UTC.
    std::int64_t SourceTime = 0;
    // Rises with each sample of this writer, by one unless samples were lost or filtered.
    std::uint64_t Sequence = 0;
    // False: the instance named by Key was disposed, or the last writer that wrote it is gone; the bytes are
    // empty. In the second case Writer is that last writer, and SourceTime and Sequence are 0.
    bool Alive = true;
    // The instance of a keyed topic; zero for a topic without a key.
    KeyHash Key{};
};

// Called once for each sample. The bytes are borrowed: they are valid only during the call.
using SampleHandler = std::function<void(SampleBytes, const SampleInfo &)>;

// A sample that is not encoded yet. The backend asks for its size and has it fill the backend's buffer, so
// that encoding is the only pass over the data.
class SampleEncoder
{
public:
    // Bytes that Encode will write, the encapsulation header included; at least 4.
    virtual std::size_t EncodedSize() const = 0;
    // Fills exactly EncodedSize() bytes. The buffer is aligned to 8. Returns false if it cannot.
    virtual bool Encode(std::span<std::uint8_t> buffer) const = 0;

protected:
    ~SampleEncoder() = default;
};

enum class WriteResult
{
    Ok,        // handed to the network; a reliable writer repairs it as long as it is in its history
    TimedOut,  // the network did not take it in time; the sample was not written
    TooLarge,  // larger than LargestSample
    Failed     // the encoder failed, or the session is closed; the backend logged why
};

// Writes samples of one topic. Thread-safe.
class TransportWriter
{
public:
    virtual ~TransportWriter() = default;
    // Encodes and sends one sample; may wait for the network for at most 100 ms. sourceTime is in nanoseconds
    // since 1970-01-01 UTC and reaches the readers unchanged (to within a microsecond).
    virtual WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) = 0;
    // Like Write, but the sample reaches the matched readers of that node alone, by unicast. Only for
    // best-effort writers of topics without a key, else Failed. For the other readers the sample is lost: its
    // number is missing, and their SamplesLost may count it. If the node has no matched reader, nothing is
    // sent and the result is Ok.
    //
    // The sample goes to the session of the node that appeared last. It also goes to each other session of
    // the node of which a reader here has delivered a sample since. Without multicast that is one datagram
    // for each. So a node that was killed and restarted costs one datagram, although its former session is
    // remembered for a while.
    virtual WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                                std::int64_t sourceTime) = 0;
    // Like Write, but only the first datagram of a sample goes now. The others are held and go in order, one
    // with each SendHeld, so that a sender that paces its datagrams can send others in between. Readers get
    // the sample with its last datagram. The next Write, WriteHeld, WriteTo or Dispose first sends the held
    // datagrams; the end of the writer and joining the network anew drop them. If a reliable reader requests
    // held datagrams, the backend sends them at once. Only UDP datagrams are held. A backend that cannot hold
    // them sends all at once.
    virtual WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime)
    {
        return Write(sample, sourceTime);
    }
    // Bytes of the next held datagram on the air, as TransportCounters count them, to all its destinations;
    // with a Member, the most that they can be. 0: none is held.
    virtual std::size_t HeldBytes() const { return 0; }
    // Sends the next held datagram.
    virtual void SendHeld() {}
    // Says that the instance named by this sample no longer exists. Only for keyed topics, else Failed.
    // Matched reliable readers are told, after the earlier samples that Depth still keeps. Once all of them
    // have acknowledged the disposal, at the latest with the next write, the writer keeps nothing of the
    // instance. It does not even keep that the instance existed. A later reader therefore hears nothing of
    // it, nor does a reader that had lost the writer meanwhile but no sample. The writer also unregisters the
    // instance, so that readers need not keep it for this writer. Writing the instance again makes it alive
    // again.
    virtual WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) = 0;
    // Readers matched now, in other sessions.
    virtual int MatchedReaders() const = 0;
    // Number of datagrams that a write of a one-datagram sample causes now, without repair: 0 without
    // readers, 1 where multicast carries it to all of them, else one for each session with readers. Cyclone
    // DDS reports its own number. The other backends compute it from this session's settings: a reader whose
    // side has no multicast costs one datagram more than reported.
    virtual int Destinations() const { return MatchedReaders(); }
};

// Receives samples of one topic until it is destroyed.
class TransportReader
{
public:
    virtual ~TransportReader() = default;
    // Writers matched now, in other sessions.
    virtual int MatchedWriters() const = 0;
};

// A session of another node that appeared or went.
struct PeerEvent
{
    enum class Kind
    {
        Appeared,
        Left,  // closed its session for good: another session of the node may appear, but not this one
        Lost   // sent nothing for its lease
    };
    Kind What = Kind::Appeared;
    std::string Node;
    std::uint64_t Incarnation = 0;
};

// Called when a Rabit node's session appears or goes; never for this session itself. Follows the rules for
// handlers above.
using PeerHandler = std::function<void(const PeerEvent &)>;

// A writer or reader of another session or program, as its discovery describes it.
struct RemoteEndpoint
{
    WriterId Id{};
    bool IsWriter = false;
    std::string Topic{};
    std::string Type{};
    Rabit::Reliability Reliability = Rabit::Reliability::BestEffort;
    // The durability that a writer offers or a reader requests; stronger ones than TransientLocal are
    // reported as TransientLocal.
    Rabit::Durability Durability = Rabit::Durability::Volatile;
    std::vector<std::string> Partitions{};  // as CreateWriter takes them
    std::string Node{};                     // empty if it does not belong to a Rabit node
    // The QoS policies that endpoints of a session do not have (OMG DDS 1.4, 2.2.3). A writer of a session
    // does not match a reader that requests one of the first two. Nothing matches an exclusive endpoint.
    bool HasDeadline = false;
    bool HasLiveliness = false;  // other than automatic, or with a lease
    bool IsExclusive = false;    // OWNERSHIP
};

// Failures below the cut since the session was opened. The counters only rise.
struct TransportCounters
{
    std::uint64_t WriteTimeouts = 0;      // writes that ended TimedOut
    std::uint64_t WriteFailures = 0;      // writes that ended Failed or TooLarge
    std::uint64_t HandlerExceptions = 0;  // handlers that threw
    std::uint64_t IncompatibleQos = 0;    // endpoints of our topics that did not match for their QoS
    std::uint64_t SamplesLost = 0;        // samples that a reader knows it has missed
    std::uint64_t InconsistentTypes = 0;  // endpoints of our topics elsewhere that have another type name
    std::uint64_t MalformedSamples = 0;   // samples dropped: too short, too large, or without a readable key
    // Datagrams dropped, in whole or in part, because they are not of the backend's protocol or no honest
    // sender would send them.
    std::uint64_t MalformedDatagrams = 0;

    // Datagrams sent since the session was opened, and their bytes on the air with the headers of IPv4 and
    // UDP (28 for each). One for each destination; a multicast datagram counts once for each network. Counted
    // where datagrams are given to the sockets (in a turn: kept for its end), so repetitions, heartbeats and
    // acknowledgements are included;
    // exact but for the headers that IP fragmentation adds. Not counted: shared memory, and anything with a
    // Fast DDS profiles file that has its own transports. The simulated network counts by the sizes of RTPS.
    std::uint64_t DiscoveryDatagrams = 0;  // of participants and endpoints, and their repair
    std::uint64_t DiscoveryBytes = 0;
    std::uint64_t SampleDatagrams = 0;  // of topics, and their repair
    std::uint64_t SampleBytes = 0;
};

// The destinations of datagrams of a turn (TransportSession::BeginTurn).
struct TurnDestinations
{
    std::uint64_t Number = 0;  // equal for equal sets of sockets, addresses and ports
    std::size_t Count = 0;     // of copies, one for each destination; 0: no datagram was kept for the turn
};

// One participant in the network.
class TransportSession
{
public:
    // Closes: peers see PeerEvent::Left. All writers and readers must be gone.
    virtual ~TransportSession() = default;
    // Makes a writer on a topic. The partitions are those of the OMG DDS specification, 2.2.3.13: names,
    // matched by equal names or by the other side's `*` and `?` patterns; "" is the default partition. An
    // empty list means {""}. Throws TransportError if the topic is open with another type in this session, or
    // if a name is impossible. Does not wait for readers, and never for the network. It may wait for a
    // handler or a write in progress (100 ms), and while the session joins the network anew (about a second).
    // The writer is announced when this returns; readers match it as they hear of it.
    virtual std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                          const std::vector<std::string> &partitions) = 0;
    // Makes a reader on a topic; the handler may be called before this returns. Samples of this session's own
    // writers are never delivered. Same rules as CreateWriter.
    virtual std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                          const std::vector<std::string> &partitions,
                                                          SampleHandler handler) = 0;
    virtual TransportCounters Counters() const = 0;
    // RemoteEndpointsOn: the endpoints on the topic that are known now, whatever their type, QoS and
    // partitions. RemoteTopics: the names of all topics on which others have endpoints, each once. For
    // occasional use: the time grows with the number of known endpoints. Empty while the session joins the
    // network.
    virtual std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string & /*topic*/) const { return {}; }
    virtual std::vector<std::string> RemoteTopics() const { return {}; }
    // The parts of the network that the settings ask for and that are missing now: interfaces that do not
    // exist or have no carrier or address, peers' names without an address. Also the reason why the network
    // could not be joined. Besides, the hosts whose unknown programs this session has refused something for
    // ten seconds (setting `stranger`, the address as the entry), and what members announce although their
    // certificates do not allow it (setting `security`, the node as the entry). FleetMember::Problems are not
    // among them. None is Impossible, and none is logged: the holder of the session reports them. Empty if
    // all is well. Any thread.
    virtual std::vector<SettingsProblem> NetworkProblems() const { return {}; }
    // Begins a turn of the calling thread: the datagrams of samples that it writes until EndTurn are sent by
    // EndTurn. Those to the same address and port go as one datagram, in the order in which they were
    // written. It has at most `mostBytes` bytes, the headers of IP and UDP included. A datagram that does not
    // fit goes by itself. Counters count a kept datagram at once, with the bytes that it adds to what is
    // sent. With a Member, the bytes of the seal are counted when the datagram goes. Returns false, and
    // begins nothing, if this session sends each datagram by itself.
    //
    // A turn is short: between the calls the thread writes some samples. Only one thread uses turns, and has
    // one turn at a time. A session that joins the network anew meanwhile drops the datagrams.
    virtual bool BeginTurn(std::size_t /*mostBytes*/) { return false; }
    // Where the datagrams that were written in this turn since the last call will go.
    virtual TurnDestinations TakeTurnDestinations() { return {}; }
    virtual void EndTurn() {}
    // Lets the holder decide when discovery sends. Null: this session does not wait for turns. Lives as long
    // as the session. Any thread.
    virtual DiscoveryTurns *Discovery() { return nullptr; }
};

// A backend.
//
// Its discovery must carry the following, so that nodes know each other, over other DDS backends too
// (transport/common/ParticipantIdentity.h). For each participant: its node name, as the participant's name,
// and its incarnation, in the participant's user data. For each endpoint: its participant, the names of topic
// and type, QoS and partitions. A participant with other user data is no Rabit node: its samples are
// delivered without a node name, and it makes no PeerEvent. Two sessions may have one name.
class Transport
{
public:
    virtual ~Transport() = default;
    // The name that a configuration file uses: `fastdds`, `cyclonedds`, `simulated`.
    virtual std::string Name() const = 0;
    // Joins the network. The peer handler may be called before this returns. Throws TransportError.
    virtual std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) = 0;
    // True: handlers run on the thread that steps the network, and nothing may run beside it, so that a run
    // is repeatable.
    virtual bool IsStepped() const { return false; }
    // All problems of the settings on this host now, found without joining the network. Open would throw for
    // the Impossible ones. May wait a second for the names of peers.
    virtual std::vector<SettingsProblem> Check(const TransportSettings & /*settings*/) const { return {}; }
};

}  // namespace Rabit
