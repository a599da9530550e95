// The cut between Rabit and a network.
//
// A backend implements the abstract classes below and nothing else; the gateway uses them and nothing else.
// Bytes cross the cut, never message classes and never a vendor's types. The same conformance suite
// (tests/transport) runs over every backend: what is written here is what it checks.
//
// Threads
//   Every method may be called from any thread, except from inside a handler (see below).
//   Handlers run on a thread of the backend. Two handlers of one reader never run at once; handlers of
//   different readers may. A handler must be quick, must not block, must not throw (what it throws is
//   caught, counted and logged) and must not call back into the transport: signal another thread instead.
//
// Lifetime
//   A session owns its participant in the network. Writers and readers belong to their session and must be
//   destroyed before it. Destroying a reader (or closing the session) returns only when no handler of it runs
//   any more; none starts afterwards.
//
// Changes of the network
//   A session may be opened before there is a network. A real backend follows the host's networks by itself.
//   One that vanishes and returns as it was needs nothing: peers are Lost and appear again. When a usable one
//   comes that the session was not opened with, or another address, the backend joins the network anew, and
//   logs it: all peers are Lost and appear again, readers get transient-local history once more, writers
//   start with an empty history, a new WriterId and new numbers. It also does so without a network that is
//   gone if a peer may go on to send there, or for loopback if no other is left. It does it seldom: for an
//   interface that comes and goes later and later, and never twice in a second. Meanwhile, and as long as
//   there is no usable network, writes end TimedOut at once and nothing is matched. Who makes or destroys a
//   writer or reader meanwhile waits for it to end, milliseconds to tenths of a second. Usable is a network
//   whose interface is up and has a carrier and an IPv4 address. Where no interface is named, it must also be
//   capable of multicast, unless multicast is off or there are peers to look for; loopback counts only when
//   it is named or nothing else is there. What the settings name and is not there is waited for, and
//   NetworkProblems says so. Processes that were stopped, or that heard nothing, for longer than the lease
//   come together again as well, whichever side had lost the other: what is Lost here appears again, and
//   endpoints match again.
//
// Errors
//   Opening something with impossible settings throws TransportError with one clear line. What can fail in
//   normal operation is a return value. Nothing that arrives from the network throws or ends the process.
#pragma once

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

// DDS Security: the files that the vendors read, in PEM and S/MIME, and who somebody is by his certificate.
// The program `rabit keys` makes them.
struct TransportSecurity
{
    std::string IdentityAuthority;     // the certificate of who signs certificates
    std::string PermissionsAuthority;  // the certificate of who signs the two documents below
    std::string Certificate;           // of this node
    std::string PrivateKey;            // of this node
    std::string Revoked;               // a list of revoked certificates; empty: none
    std::string Governance;
    std::string Permissions;
    // Whether Governance has discovery encrypted; only for a hint in the log.
    bool Encrypts = true;
    // Whether a participant whose GUID begins with these bytes may call itself that node: they are bound to
    // the subject of its certificate (OMG DDS Security 1.1, 9.3.3). One that may not is taken for a program
    // that is no node. Called on any thread; must not throw. Empty: everybody may.
    std::function<bool(std::string_view node, std::span<const std::uint8_t, 12> guidPrefix)> MayBe;
};

// Settings common to all backends.
struct TransportSettings
{
    // Unique name of this node, 1 to 200 bytes of UTF-8. Becomes the participant's name.
    std::string Node;
    // Which life of the node this is; peers see it in SampleInfo and PeerEvent.
    std::uint64_t Incarnation = 0;
    // DDS domain, 0 to 232.
    int Domain = 0;
    // Network interfaces to use, by name or address; empty: all that are usable. One that is not there is
    // waited for.
    std::vector<std::string> Interfaces;
    // Addresses of peers for unicast discovery, `host` or `host:port`; empty: discovery by multicast alone. A
    // host may be a name; one that has no address yet is looked up again and again.
    std::vector<std::string> Peers;
    // Whether multicast may be used, for discovery and for samples with more than one reader. Where Peers are
    // listed it is for discovery alone: it may not pass to all of them.
    bool Multicast = true;
    // The range of MaxDatagram.
    static constexpr std::size_t SmallestDatagram = 1000;
    static constexpr std::size_t LargestDatagram = 65000;
    // Largest datagram to send, 1000 to 65000 bytes; larger ones are received all the same. The default stays
    // below the MTU of radios, because one lost IP fragment of a larger datagram loses the whole of it. Use
    // 65000 on loopback and wired networks.
    std::size_t MaxDatagram = 1400;
    // Use shared memory between processes of one host. Off by default: a killed process leaves files behind.
    bool SharedMemory = false;
    // A peer that says nothing for this long is lost; it announces itself every AnnouncementPeriod at the
    // latest, more often at first, and to who has not heard it. The period is how long those who were out of
    // reach of each other for longer than the lease may take to find each other again, and what a node costs
    // that has nothing to say: some 400 bytes each time.
    std::chrono::milliseconds Lease{30000};
    std::chrono::milliseconds AnnouncementPeriod{10000};
    // A Rabit node that is silent is remembered for this long, so that nothing has to be found out again when
    // it is back: the lease holds for it only where samples do not go by multicast, and with security.
    // Another session of the same node ends the former one, once that is silent for some seconds.
    std::chrono::milliseconds Memory{std::chrono::hours(4)};
    // A vendor's own configuration file, for the expert; empty: none.
    std::string BackendConfig;
    // Set: only who has a certificate of the same authority is heard and answered, and may do what its
    // permissions say. A backend without security throws TransportError.
    std::optional<TransportSecurity> Security{};
    // Takes the session's log lines (handlers that threw, writes that failed, types that differ ...), without
    // a newline; called on any thread, must be quick and thread-safe. Not set: only the counters tell.
    std::function<void(const std::string &)> Log;
};

// Something that is wrong with a setting, here and now.
struct SettingsProblem
{
    std::string Setting;  // as a configuration file calls it: `interfaces`, `peers`, `backend_config` ...
    std::string Entry;    // the one of several that is meant: an interface, a peer; else empty
    std::string Text;     // one line for people, with the entry's name in it
    // Opening a session throws for it. If not, the session waits for what is missing, and does without.
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
    TransientLocal  // a late reader also gets the writer's history; so may one that had lost the writer, once
                    // more
};

// What every backend can send as one sample, in bytes, the encapsulation header included. Larger ones are
// neither sent nor accepted, so that nobody is made to allocate more.
inline constexpr std::size_t LargestSample = std::size_t{64} << 20;

// Quality of service of a writer or reader, in the terms of the OMG DDS specification, section 2.2.3.
// The history is always keep-last: a slow reader never blocks a writer for ever.
struct TopicQos
{
    Rabit::Reliability Reliability = Rabit::Reliability::Reliable;
    Rabit::Durability Durability = Rabit::Durability::Volatile;
    // Samples kept by the writer for repair and for late readers (for each key if the topic is keyed). A
    // volatile writer lets go of a sample before that, once all readers that are matched have acknowledged it
    // (best-effort ones: once it is sent), at the latest with the next write; so it holds what is under way,
    // and nothing while nobody is matched. A transient-local one keeps it until another pushes it out, or its
    // instance is disposed.
    // A reader hands each sample over as it arrives and keeps none back, only the keys of instances that
    // live: samples of one writer never push out those of another, keyed topic or not.
    int Depth = 1;
};

// 16 bytes that name an instance of a keyed topic, computed as in the OMG DDSI-RTPS specification, 9.6.3.8.
using KeyHash = std::array<std::uint8_t, 16>;

// A sample as it is on the wire: the 4-byte encapsulation header, then XCDR1. The two low bits of the
// header's last byte may be set on the way: the number of padding bytes that RTPS added (OMG
// DDS-XTypes 1.3, 7.6.3.1.2), which are not part of the bytes handed over. A writer of another make that does
// not set them may leave up to three zero bytes at the end.
using SampleBytes = std::span<const std::uint8_t>;

// What a topic is. Writer and reader match if Name and TypeName are equal and the QoS and partitions fit.
struct TopicDescription
{
    std::string Name;      // for instance `Pose`
    std::string TypeName;  // the IDL name, for instance `Uav::Pose`
    // Set if and only if the type has a key. Computes the key hash of a sample; returns false if the bytes do
    // not decode. Called on any thread, also several at once; must not throw.
    std::function<bool(SampleBytes, KeyHash &)> KeyOf;
};

// 16 bytes that identify one writer in the network (an RTPS GUID), unlike those of all other writers.
using WriterId = std::array<std::uint8_t, 16>;

// What comes with a sample. Valid only during the handler's call.
struct SampleInfo
{
    WriterId Writer{};
    // Name of the node that wrote it; empty if the writer is not a Rabit node (a plain DDS program).
    std::string_view Node;
    // Incarnation of that node; 0 if the writer is not a Rabit node.
    std::uint64_t Incarnation = 0;
    // When it was written by the writer's clock, in nanoseconds since 1970-01-01 UTC.
    std::int64_t SourceTime = 0;
    // Rises with each sample of this writer, by one unless samples were lost or filtered.
    std::uint64_t Sequence = 0;
    // False: the instance named by Key was disposed, or the last writer that wrote it is gone; the bytes are
    // empty. In the second case Writer is that last writer, and SourceTime and Sequence are 0.
    bool Alive = true;
    // The instance of a keyed topic; zero for one without a key.
    KeyHash Key{};
};

// Called once for each sample. The bytes are borrowed: they are valid only during the call.
using SampleHandler = std::function<void(SampleBytes, const SampleInfo &)>;

// A sample that is still to be encoded: the backend asks how big it is and has it fill the backend's buffer,
// so that encoding is the only pass over the data.
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
    // As Write, but the sample reaches the matched readers of that node alone, by unicast. For best-effort
    // writers of topics without a key only, else Failed. For the other readers it is a sample lost: its
    // number is missing, and their SamplesLost may count it. Ok as well if the node has no reader that is
    // matched; then nothing is sent.
    //
    // It goes to the session of the node that appeared last, and to each other one of which a reader of this
    // session has handed over a sample since; without multicast as one datagram for each. So a node that was
    // killed and restarted costs one datagram, although its former session is remembered for a while.
    virtual WriteResult WriteTo(const std::string &node, const SampleEncoder &sample,
                                std::int64_t sourceTime) = 0;
    // As Write, but of a sample that takes several datagrams only the first one goes now. The others are
    // held, and go in their order, one with each SendHeld, so that others may go between: for a sender that
    // paces its datagrams. Readers get the sample with its last datagram. The next Write, WriteHeld, WriteTo
    // or Dispose sends first what is held then; the end of the writer and a session that joins the network
    // anew drop it. A reliable reader may ask for what is held, and is then sent it by the backend at once.
    // Only datagrams of UDP are held. A backend that cannot hold them sends all at once.
    virtual WriteResult WriteHeld(const SampleEncoder &sample, std::int64_t sourceTime)
    {
        return Write(sample, sourceTime);
    }
    // Bytes of the next held datagram on the air, as TransportCounters count them, to all its destinations;
    // 0: none is held.
    virtual std::size_t HeldBytes() const { return 0; }
    // Sends it.
    virtual void SendHeld() {}
    // Says that the instance that this sample names is no more. Only for keyed topics, Failed otherwise.
    // Reliable readers that are matched are told, after what was written before as far as Depth keeps it.
    // Once all of them have acknowledged that, at the latest with the next write, the writer holds nothing of
    // the instance, not even that it was there: a reader that matches later hears nothing of it, nor does one
    // that lost nothing while the writer had lost it. The writer has unregistered the instance, too: readers
    // need not keep it for this writer. Writing it again makes it alive again.
    virtual WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) = 0;
    // Readers matched now, in other sessions.
    virtual int MatchedReaders() const = 0;
    // How many datagrams a write of a sample that fits into one causes now, without its repair: 0 without
    // readers, 1 where multicast carries it to all of them, else one for each session with readers. With
    // Cyclone DDS as the vendor has it; the others go by the own settings, so a reader whose side is without
    // multicast is one more in truth.
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

// A session of another node that came or went.
struct PeerEvent
{
    enum class Kind
    {
        Appeared,
        Left,  // closed its session, for good: another session of the node may appear, this one does not
        Lost   // said nothing for its lease
    };
    Kind What = Kind::Appeared;
    std::string Node;
    std::uint64_t Incarnation = 0;
};

// Called when a Rabit node's session appears or goes; never for this session itself. Runs under the rules for
// handlers above.
using PeerHandler = std::function<void(const PeerEvent &)>;

// A writer or reader of another session or another program, as its discovery tells of it.
struct RemoteEndpoint
{
    WriterId Id{};
    bool IsWriter = false;
    std::string Topic{};
    std::string Type{};
    Rabit::Reliability Reliability = Rabit::Reliability::BestEffort;
    // Of a writer what it keeps, of a reader what it asks for; what is more durable than TransientLocal is
    // TransientLocal here.
    Rabit::Durability Durability = Rabit::Durability::Volatile;
    std::vector<std::string> Partitions{};  // as CreateWriter takes them
    std::string Node{};                     // empty if it is not of a Rabit node
};

// Things that went wrong below the cut since the session was opened. They only rise.
struct TransportCounters
{
    std::uint64_t WriteTimeouts = 0;      // writes that ended TimedOut
    std::uint64_t WriteFailures = 0;      // writes that ended Failed or TooLarge
    std::uint64_t HandlerExceptions = 0;  // handlers that threw
    std::uint64_t IncompatibleQos = 0;    // endpoints of our topics that did not match for their QoS
    std::uint64_t SamplesLost = 0;        // samples that a reader knows it has missed
    std::uint64_t InconsistentTypes = 0;  // endpoints of our topics elsewhere that have another type name
    std::uint64_t MalformedSamples = 0;   // samples dropped: too short, too large, or without a readable key
    // Datagrams dropped, in whole or in part, because they are not of the backend's protocol or say what
    // their sender cannot honestly say.
    std::uint64_t MalformedDatagrams = 0;

    // What the session has sent since it was opened, as it is on the air: datagrams, and their bytes with the
    // headers of IPv4 and UDP (28 for each). One for each destination; a multicast one once for each network.
    // Counted where datagrams are given to the sockets, so repetitions, heartbeats and acknowledgements are
    // in it; exact but for what IP adds to datagrams that it must cut. Shared memory is not counted, nor is
    // anything with a Fast DDS profiles file that has own transports. The simulated network counts what it
    // sends by the sizes of RTPS.
    std::uint64_t DiscoveryDatagrams = 0;  // of participants and endpoints, and their repair
    std::uint64_t DiscoveryBytes = 0;
    std::uint64_t SampleDatagrams = 0;  // of topics, and their repair
    std::uint64_t SampleBytes = 0;
};

// One participant in the network.
class TransportSession
{
public:
    // Closes: peers see PeerEvent::Left. All writers and readers must be gone.
    virtual ~TransportSession() = default;
    // Makes a writer on a topic. The partitions are those of the OMG DDS specification, 2.2.3.13: names,
    // matched by equal names or by the other side's `*` and `?` patterns; "" is the default partition. An
    // empty list means {""}. Throws TransportError if the same topic name was opened with another type in
    // this session. Does not wait for readers, and never for the network: it may take as long as a handler or
    // a write that is under way (100 ms), and while the session joins the network anew as long as that takes
    // (a second or so). The writer is announced when this returns; readers match it as they hear of it.
    virtual std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                          const std::vector<std::string> &partitions) = 0;
    // Makes a reader on a topic; the handler may be called before this returns. Samples of this session's own
    // writers are never handed over. Same rules as CreateWriter.
    virtual std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                          const std::vector<std::string> &partitions,
                                                          SampleHandler handler) = 0;
    virtual TransportCounters Counters() const = 0;
    // The endpoints on a topic of that name that are known now, whatever their type, QoS and partitions; and
    // the names of all topics that others have endpoints on, each once. For looking at now and then: takes a
    // time that grows with all that is known. Empty while the session joins the network.
    virtual std::vector<RemoteEndpoint> RemoteEndpointsOn(const std::string & /*topic*/) const { return {}; }
    virtual std::vector<std::string> RemoteTopics() const { return {}; }
    // What of the network that the settings ask for is missing now: interfaces that do not exist or have no
    // carrier or address, peers' names without an address; and why it could not be joined. None of them
    // Impossible, and none is logged: whoever holds the session tells people. Empty if all is well.
    virtual std::vector<SettingsProblem> NetworkProblems() const { return {}; }
    // Bytes in a second, as counted by TransportCounters, that the nodes' exchange of cards may take; 0, as at
    // first: as many as it needs. Announcements of participants are not held back. Any thread; does not
    // wait.
    virtual void SetDiscoveryRate(double /*bytesPerSecond*/) {}
};

// A backend.
//
// What its discovery has to carry, so that nodes know each other, those over other DDS backends included
// (transport/common/ParticipantIdentity.h): with each participant its node name, as the participant's name,
// and its incarnation, in the participant's user data; with each endpoint, the participant that it belongs
// to, the names of topic and type, QoS and partitions. A participant with other user data is no Rabit node:
// its samples are handed over without a node name, and it makes no PeerEvent. Two sessions may have one name.
class Transport
{
public:
    virtual ~Transport() = default;
    // The name that a configuration file uses: `fastdds`, `cyclonedds`, `simulated`.
    virtual std::string Name() const = 0;
    // Joins the network. The peer handler may be called before this returns. Throws TransportError.
    virtual std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) = 0;
    // True: handlers run on the thread that steps the network, and nothing may run beside it, so that a run
    // can be repeated.
    virtual bool IsStepped() const { return false; }
    // All that is wrong with the settings on this host now, without joining the network: what is Impossible
    // would make Open throw. May wait a second for the names of peers.
    virtual std::vector<SettingsProblem> Check(const TransportSettings & /*settings*/) const { return {}; }
};

}  // namespace Rabit
