#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include <arpa/inet.h>
#include <dds/dds.h>
#include <dds/ddsc/dds_rhc.h>
#include <dds/ddsi/ddsi_rhc.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include "OpaqueType.h"
#include "common/HandlerGate.h"
#include "common/InstanceTable.h"
#include "common/ParticipantIdentity.h"
#include "common/SettingsCheck.h"
#include "common/TopicRegistry.h"

namespace Rabit
{

namespace
{

using namespace Cyclone;
using Prefix = std::array<std::uint8_t, 12>;

constexpr std::size_t MaxSample = std::size_t{64} << 20;

WriterId ToWriterId(const ddsi_guid_t &guid)
{
    const std::uint32_t parts[4] = {htonl(guid.prefix.u[0]), htonl(guid.prefix.u[1]), htonl(guid.prefix.u[2]),
                                    htonl(guid.entityid.u)};
    WriterId id;
    std::memcpy(id.data(), parts, sizeof parts);
    return id;
}

WriterId ToWriterId(const dds_guid_t &guid)
{
    WriterId id;
    std::memcpy(id.data(), guid.v, id.size());
    return id;
}

Prefix PrefixOf(const WriterId &id)
{
    Prefix prefix;
    std::memcpy(prefix.data(), id.data(), prefix.size());
    return prefix;
}

std::string MakeXml(const TransportSettings &settings)
{
    std::ostringstream xml;
    xml << "<General><Interfaces>";
    for (const auto &address : ResolveInterfaces(settings.Interfaces))
    {
        xml << "<NetworkInterface address=\"" << address << "\" multicast=\""
            << (settings.Multicast ? "true" : "false") << "\"/>";
    }
    if (settings.Interfaces.empty())
    {
        xml << "<NetworkInterface autodetermine=\"true\"/>";
    }
    xml << "</Interfaces><AllowMulticast>" << (settings.Multicast ? "true" : "false") << "</AllowMulticast>"
        << "<MaxMessageSize>" << settings.MaxDatagram << "B</MaxMessageSize>"
        << "<FragmentSize>" << settings.MaxDatagram - 100 << "B</FragmentSize></General>"
        << "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
        << "<MaxAutoParticipantIndex>100</MaxAutoParticipantIndex>"
        << "<LeaseDuration>" << settings.Lease.count() << "ms</LeaseDuration>"
        << "<SPDPInterval>" << settings.AnnouncementPeriod.count() << "ms</SPDPInterval><Peers>";
    for (const auto &peer : settings.Peers)
    {
        const PeerAddress address = ResolvePeer(peer);
        xml << "<Peer address=\"" << address.Address;
        if (address.Port != 0)
        {
            xml << ":" << address.Port;
        }
        xml << "\"/>";
    }
    xml << "</Peers></Discovery><Internal><GenerateKeyhash>true</GenerateKeyhash>"
        << "<HeartbeatInterval>20ms</HeartbeatInterval>"
        << "<Watermarks><WhcHigh>128MB</WhcHigh></Watermarks></Internal>"
        << "<Tracing><Category>discovery</Category><OutputFile>/dev/null</OutputFile></Tracing>";
    std::string text = xml.str();
    if (!settings.BackendConfig.empty())
    {
        std::ifstream file(settings.BackendConfig);
        std::ostringstream content;
        if (!file || !(content << file.rdbuf()))
        {
            throw TransportError("the Cyclone DDS configuration " + settings.BackendConfig +
                                 " cannot be read");
        }
        text = "<Domain>" + text + "</Domain>," + content.str();
    }
    return text;
}

// Which participants the vendor dropped for their silence: it tells that in its trace alone.
class ExpiredLeases
{
public:
    static ExpiredLeases &Get()
    {
        static ExpiredLeases leases;
        return leases;
    }
    bool Take(const Prefix &prefix)
    {
        const std::lock_guard lock(_mutex);
        return std::erase(_prefixes, prefix) > 0;
    }
    static void Listen() { dds_set_trace_sink(&Sink, nullptr); }

private:
    static void Sink(void *, const dds_log_data_t *data)
    {
        const std::string_view line(data->message, data->size);
        const auto at = line.find("lease expired:");
        const auto guid = at == std::string_view::npos ? at : line.find("guid ", at);
        unsigned parts[3];
        if (guid != std::string_view::npos &&
            std::sscanf(data->message + guid, "guid %x:%x:%x", &parts[0], &parts[1], &parts[2]) == 3)
        {
            for (auto &part : parts)
            {
                part = htonl(part);
            }
            Prefix prefix;
            std::memcpy(prefix.data(), parts, prefix.size());
            auto &self = Get();
            const std::lock_guard lock(self._mutex);
            self._prefixes.push_back(prefix);
            if (self._prefixes.size() > 256)
            {
                self._prefixes.pop_front();
            }
        }
    }
    std::mutex _mutex;
    std::deque<Prefix> _prefixes;
};

// The domain of this process, shared by its sessions.
class DomainUse
{
public:
    explicit DomainUse(const TransportSettings &settings) : _id(static_cast<dds_domainid_t>(settings.Domain))
    {
        const std::string xml = MakeXml(settings);
        const std::lock_guard lock(Mutex());
        auto &open = Domains()[_id];
        if (open.Count > 0 && open.Xml != xml)
        {
            throw TransportError("another session of this process is in domain " + std::to_string(_id) +
                                 " with other network settings; Cyclone DDS needs them to be equal");
        }
        if (open.Count == 0)
        {
            ExpiredLeases::Listen();
            open.Entity = dds_create_domain(_id, xml.c_str());
            if (open.Entity < 0)
            {
                const std::string why = dds_strretcode(open.Entity);
                Domains().erase(_id);
                throw TransportError("Cyclone DDS cannot join domain " + std::to_string(_id) + ": " + why);
            }
            open.Xml = xml;
        }
        ++open.Count;
    }
    ~DomainUse()
    {
        const std::lock_guard lock(Mutex());
        const auto open = Domains().find(_id);
        if (--open->second.Count == 0)
        {
            dds_delete(open->second.Entity);
            Domains().erase(open);
        }
    }
    DomainUse(const DomainUse &) = delete;
    DomainUse &operator=(const DomainUse &) = delete;

private:
    struct Open
    {
        dds_entity_t Entity = 0;
        int Count = 0;
        std::string Xml;
    };
    static std::mutex &Mutex()
    {
        static std::mutex mutex;
        return mutex;
    }
    static std::map<dds_domainid_t, Open> &Domains()
    {
        static std::map<dds_domainid_t, Open> domains;
        return domains;
    }
    const dds_domainid_t _id;
};

// A thread that does what it is given, in order.
class Worker
{
public:
    Worker() : _thread([this] { Run(); }) {}
    ~Worker()
    {
        {
            const std::lock_guard lock(_mutex);
            _stop = true;
        }
        _changed.notify_one();
        _thread.join();
    }
    void Post(std::function<void()> work)
    {
        {
            const std::lock_guard lock(_mutex);
            _work.push_back(std::move(work));
        }
        _changed.notify_one();
    }

private:
    void Run()
    {
        std::unique_lock lock(_mutex);
        while (true)
        {
            _changed.wait(lock, [this] { return _stop || !_work.empty(); });
            if (_work.empty())
            {
                return;
            }
            auto work = std::move(_work.front());
            _work.pop_front();
            lock.unlock();
            work();
            work = nullptr;
            lock.lock();
        }
    }
    std::mutex _mutex;
    std::condition_variable _changed;
    std::deque<std::function<void()>> _work;
    bool _stop = false;
    std::thread _thread;
};

class Core
{
public:
    Core(const TransportSettings &settings, PeerHandler onPeer)
        : Log((CheckSettings(settings), std::make_shared<SessionLog>(settings))),
          Topics(Log),
          PeerGate(Log, "peer events"),
          _onPeer(std::move(onPeer)),
          _domain(settings)
    {
        if (settings.SharedMemory)
        {
            Log->Line("this build of Cyclone DDS has no shared memory: UDP is used");
        }
        dds_qos_t *qos = dds_create_qos();
        dds_qset_entity_name(qos, settings.Node.c_str());
        const std::string data = MakeUserData(settings.Incarnation);
        dds_qset_userdata(qos, data.data(), data.size());
        Participant = dds_create_participant(static_cast<dds_domainid_t>(settings.Domain), qos, nullptr);
        dds_delete_qos(qos);
        if (Participant < 0)
        {
            throw TransportError("Cyclone DDS cannot join domain " + std::to_string(settings.Domain) + ": " +
                                 dds_strretcode(Participant));
        }
        dds_guid_t guid;
        dds_get_guid(Participant, &guid);
        _own = PrefixOf(ToWriterId(guid));
        for (const dds_entity_t topic : {DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, DDS_BUILTIN_TOPIC_DCPSPUBLICATION,
                                         DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION})
        {
            dds_listener_t *listener = dds_create_listener(this);
            dds_lset_data_available(
                listener, topic == DDS_BUILTIN_TOPIC_DCPSPARTICIPANT ? &OnParticipants : &OnEndpoints);
            const dds_entity_t reader = dds_create_reader(Participant, topic, nullptr, listener);
            dds_delete_listener(listener);
            // What came before the listener was in place.
            (topic == DDS_BUILTIN_TOPIC_DCPSPARTICIPANT ? OnParticipants : OnEndpoints)(reader, this);
        }
    }
    ~Core()
    {
        Close();
        dds_delete(Participant);
    }
    void Close()
    {
        Closed = true;
        PeerGate.Close();
    }
    ParticipantIdentity IdentityOf(const WriterId &writer)
    {
        const std::lock_guard lock(_mutex);
        const auto found = _known.find(PrefixOf(writer));
        return found == _known.end() ? ParticipantIdentity{} : found->second;
    }

    const std::shared_ptr<SessionLog> Log;
    TopicRegistry Topics;
    HandlerGate PeerGate;
    dds_entity_t Participant = 0;
    std::atomic<bool> Closed{false};

private:
    static void OnParticipants(dds_entity_t reader, void *self)
    {
        static_cast<Core *>(self)->TakeParticipants(reader);
    }
    static void OnEndpoints(dds_entity_t reader, void *self)
    {
        static_cast<Core *>(self)->TakeEndpoints(reader);
    }

    void TakeParticipants(dds_entity_t reader)
    {
        void *values[1] = {nullptr};
        dds_sample_info_t info;
        while (dds_take(reader, values, &info, 1, 1) == 1)
        {
            const auto *peer = static_cast<const dds_builtintopic_participant_t *>(values[0]);
            const Prefix prefix = PrefixOf(ToWriterId(peer->key));
            if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
            {
                PeerGone(prefix);
            }
            else if (info.valid_data)
            {
                PeerAppeared(prefix, peer->qos);
            }
            dds_return_loan(reader, values, 1);
            values[0] = nullptr;
        }
    }
    void PeerAppeared(const Prefix &prefix, const dds_qos_t *qos)
    {
        void *data = nullptr;
        std::size_t size = 0;
        char *name = nullptr;
        if (prefix == _own || !dds_qget_userdata(qos, &data, &size))
        {
            return;
        }
        const auto incarnation = ParseUserData({static_cast<const std::uint8_t *>(data), size});
        dds_free(data);
        if (!incarnation)
        {
            return;
        }
        dds_qget_entity_name(qos, &name);
        const ParticipantIdentity identity{name != nullptr ? name : "", *incarnation};
        dds_free(name);
        {
            const std::lock_guard lock(_mutex);
            if (!_peers.emplace(prefix, identity).second)
            {
                return;
            }
            _known.insert_or_assign(prefix, identity);
        }
        Tell(PeerEvent::Kind::Appeared, identity);
    }
    void PeerGone(const Prefix &prefix)
    {
        const bool expired = ExpiredLeases::Get().Take(prefix);
        ParticipantIdentity identity;
        {
            const std::lock_guard lock(_mutex);
            const auto found = _peers.find(prefix);
            if (found == _peers.end())
            {
                return;
            }
            identity = found->second;
            _peers.erase(found);
            // Its last samples may still wait for their handler.
            _gone.push_back(prefix);
            if (_gone.size() > 64)
            {
                if (_peers.find(_gone.front()) == _peers.end())
                {
                    _known.erase(_gone.front());
                }
                _gone.pop_front();
            }
        }
        Tell(expired ? PeerEvent::Kind::Lost : PeerEvent::Kind::Left, identity);
    }
    void Tell(PeerEvent::Kind kind, const ParticipantIdentity &identity)
    {
        _worker.Post(
            [this, kind, identity]
            {
                PeerGate.Run(
                    [&]
                    {
                        if (_onPeer)
                        {
                            _onPeer({kind, identity.Node, identity.Incarnation});
                        }
                    });
            });
    }
    void TakeEndpoints(dds_entity_t reader)
    {
        void *values[1] = {nullptr};
        dds_sample_info_t info;
        while (dds_take(reader, values, &info, 1, 1) == 1)
        {
            const auto *endpoint = static_cast<const dds_builtintopic_endpoint_t *>(values[0]);
            const WriterId id = ToWriterId(endpoint->key);
            if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
            {
                Topics.RemoteGone(id);
            }
            else if (info.valid_data && PrefixOf(id) != _own)
            {
                Topics.RemoteAppeared(id, endpoint->topic_name, endpoint->type_name);
            }
            dds_return_loan(reader, values, 1);
            values[0] = nullptr;
        }
    }

    const PeerHandler _onPeer;
    const DomainUse _domain;
    Prefix _own{};
    std::mutex _mutex;
    std::map<Prefix, ParticipantIdentity> _peers;  // guarded by _mutex
    std::map<Prefix, ParticipantIdentity> _known;  // those and some that went; guarded by _mutex
    std::deque<Prefix> _gone;                      // guarded by _mutex
    Worker _worker;
};

dds_qos_t *MakeQos(const TopicQos &qos, const std::vector<std::string> &partitions, bool writer)
{
    dds_qos_t *result = dds_create_qos();
    dds_qset_reliability(
        result,
        qos.Reliability == Reliability::Reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
        DDS_MSECS(100));
    dds_qset_durability(result, qos.Durability == Durability::TransientLocal ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                                             : DDS_DURABILITY_VOLATILE);
    dds_qset_history(result, DDS_HISTORY_KEEP_LAST, qos.Depth);
    if (writer)
    {
        dds_qset_durability_service(result, 0, DDS_HISTORY_KEEP_LAST, qos.Depth, DDS_LENGTH_UNLIMITED,
                                    DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
        dds_qset_writer_data_lifecycle(result, false);
    }
    dds_qset_ignorelocal(result, DDS_IGNORELOCAL_PARTICIPANT);
    const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(result, 1, &representation);
    std::vector<const char *> names;
    for (const auto &name : partitions)
    {
        names.push_back(name.c_str());
    }
    if (names.empty())
    {
        names.push_back("");
    }
    dds_qset_partition(result, static_cast<std::uint32_t>(names.size()), names.data());
    return result;
}

// `used` becomes the type that the vendor uses, which lives as long as the topic.
dds_entity_t MakeTopic(Core &core, const TopicDescription &topic, const ddsi_sertype *&used)
{
    ddsi_sertype *type = NewType(topic);
    const dds_entity_t entity =
        dds_create_topic_sertype(core.Participant, topic.Name.c_str(), &type, nullptr, nullptr, nullptr);
    if (entity < 0)
    {
        ddsi_sertype_unref(type);
        throw TransportError("Cyclone DDS cannot make topic " + topic.Name + ": " + dds_strretcode(entity));
    }
    used = type;
    return entity;
}

class CycloneWriter final : public TransportWriter
{
public:
    CycloneWriter(std::shared_ptr<Core> core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions)
        : _core(std::move(core)),
          _topic(topic),
          _use(_core->Topics, topic),
          _entityTopic(MakeTopic(*_core, topic, _type))
    {
        dds_qos_t *settings = MakeQos(qos, partitions, true);
        dds_listener_t *listener = dds_create_listener(this);
        dds_lset_offered_incompatible_qos(
            listener,
            [](dds_entity_t, const dds_offered_incompatible_qos_status_t, void *self)
            {
                const auto *writer = static_cast<CycloneWriter *>(self);
                writer->_core->Log->IncompatibleQos(writer->_topic.Name);
            });
        _writer = dds_create_writer(_core->Participant, _entityTopic, settings, listener);
        dds_delete_listener(listener);
        dds_delete_qos(settings);
        if (_writer < 0)
        {
            dds_delete(_entityTopic);
            throw TransportError("Cyclone DDS cannot make a writer of topic " + topic.Name + ": " +
                                 dds_strretcode(_writer));
        }
    }
    ~CycloneWriter() override
    {
        dds_delete(_writer);
        dds_delete(_entityTopic);
    }
    WriteResult Write(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return Send(sample, sourceTime, false);
    }
    WriteResult Dispose(const SampleEncoder &sample, std::int64_t sourceTime) override
    {
        return _topic.KeyOf ? Send(sample, sourceTime, true)
                            : Fail("it has no key, so nothing of it can be disposed");
    }
    int MatchedReaders() const override
    {
        dds_publication_matched_status_t status{};
        dds_get_publication_matched_status(_writer, &status);
        return static_cast<int>(status.current_count);
    }

private:
    WriteResult Fail(const char *why, WriteResult result = WriteResult::Failed)
    {
        _core->Log->WriteFailed(_topic.Name, why);
        return result;
    }
    WriteResult Send(const SampleEncoder &encoder, std::int64_t sourceTime, bool dispose)
    {
        if (_core->Closed)
        {
            return Fail("the session is closed");
        }
        const std::size_t size = encoder.EncodedSize();
        if (size > MaxSample)
        {
            return Fail("the sample is larger than 64 MiB", WriteResult::TooLarge);
        }
        if (size < 4)
        {
            return Fail("the encoded sample is shorter than its header");
        }
        const auto release = [](OpaqueSample *s) { ddsi_serdata_unref(&s->Header); };
        std::unique_ptr<OpaqueSample, decltype(release)> sample(
            NewSample(_type, dispose ? SDK_KEY : SDK_DATA, size), release);
        if (!encoder.Encode({sample->Data(), size}))
        {
            return Fail("the sample cannot be encoded");
        }
        if (_topic.KeyOf && !_topic.KeyOf({sample->Data(), size}, sample->Key))
        {
            return Fail("the encoded sample has no readable key");
        }
        std::uint32_t parts[4];
        std::memcpy(parts, sample->Key.data(), sizeof parts);
        sample->Header.hash ^= parts[0] ^ parts[1] * 31u ^ parts[2] * 131u ^ parts[3] * 1031u;
        sample->Data()[3] = static_cast<std::uint8_t>((sample->Data()[3] & ~3u) | ((4 - size % 4) % 4));
        sample->Header.timestamp.v = sourceTime;
        sample->Header.statusinfo = dispose ? 1u : 0u;
        const std::lock_guard lock(_order);
        sample->Sequence = _sequence + 1;
        const dds_return_t result = dds_forwardcdr(_writer, &sample.release()->Header);
        if (result == DDS_RETCODE_TIMEOUT)
        {
            _core->Log->WriteTimedOut(_topic.Name);
            return WriteResult::TimedOut;
        }
        if (result != DDS_RETCODE_OK)
        {
            return Fail(dds_strretcode(result));
        }
        ++_sequence;
        return WriteResult::Ok;
    }

    const std::shared_ptr<Core> _core;
    const TopicDescription _topic;
    const TopicRegistry::Use _use;
    const ddsi_sertype *_type = nullptr;
    const dds_entity_t _entityTopic;
    std::mutex _order;
    std::uint64_t _sequence = 0;  // guarded by _order
    dds_entity_t _writer = 0;
};

// What a reader's cache, thread and handler share.
struct ReaderState
{
    ReaderState(std::shared_ptr<Core> core, const TopicDescription &description, SampleHandler handler)
        : Session(std::move(core)),
          Topic(description),
          Handler(std::move(handler)),
          Gate(Session->Log, "the reader of " + description.Name)
    {
    }
    void HandOver(const OpaqueSample &sample, const WriterId &writer)
    {
        SampleInfo info;
        const auto identity = Session->IdentityOf(writer);
        info.Writer = writer;
        info.Node = identity.Node;
        info.Incarnation = identity.Incarnation;
        info.SourceTime = sample.Header.timestamp.v;
        info.Sequence = sample.Sequence;
        info.Key = sample.Key;
        if ((sample.Header.statusinfo & 3u) == 0)
        {
            std::size_t size = sample.Size;
            if (size > 4 && size % 4 == 0)
            {
                size -= std::min<std::size_t>(sample.Data()[3] & 3u, size - 4);
            }
            if (Topic.KeyOf)
            {
                Instances.Alive(info.Key, writer);
            }
            Handler({sample.Data(), size}, info);
            return;
        }
        if (!Topic.KeyOf)
        {
            return;
        }
        info.Alive = false;
        if ((sample.Header.statusinfo & 1u) != 0)
        {
            Instances.Disposed(info.Key);
        }
        else if (Instances.Unregistered(info.Key, writer))
        {
            info.SourceTime = 0;
            info.Sequence = 0;
        }
        else
        {
            return;
        }
        Handler({}, info);
    }
    void WriterGone(const WriterId &writer)
    {
        const auto identity = Session->IdentityOf(writer);
        for (const auto &key : Instances.WriterGone(writer))
        {
            SampleInfo info;
            info.Writer = writer;
            info.Node = identity.Node;
            info.Incarnation = identity.Incarnation;
            info.Alive = false;
            info.Key = key;
            Gate.Run([&] { Handler({}, info); });
        }
    }

    const std::shared_ptr<Core> Session;
    const TopicDescription Topic;
    const SampleHandler Handler;
    HandlerGate Gate;
    InstanceTable Instances;  // on the worker's thread alone
    Worker Thread;
};

// Stands where the vendor keeps a reader's history: passes everything on to the reader's thread, in order.
struct PassingCache
{
    dds_rhc Base;
    std::shared_ptr<ReaderState> State;
};

PassingCache *CacheOf(void *cache)
{
    return static_cast<PassingCache *>(cache);
}

const dds_rhc_ops &CacheOps()
{
    static const dds_rhc_ops ops = []
    {
        dds_rhc_ops o{};
        o.rhc_ops.store = [](ddsi_rhc *cache, const ddsi_writer_info *writer, ddsi_serdata *sample,
                             ddsi_tkmap_instance *) -> bool
        {
            auto *state = CacheOf(cache)->State.get();
            const std::shared_ptr<ddsi_serdata> held(ddsi_serdata_ref(sample), &ddsi_serdata_unref);
            state->Thread.Post(
                [state, held, id = ToWriterId(writer->guid)]
                {
                    const auto &opaque = *reinterpret_cast<const OpaqueSample *>(held.get());
                    state->Gate.Run([&] { state->HandOver(opaque, id); });
                });
            return true;
        };
        o.rhc_ops.unregister_wr = [](ddsi_rhc *cache, const ddsi_writer_info *writer)
        {
            auto *state = CacheOf(cache)->State.get();
            state->Thread.Post([state, id = ToWriterId(writer->guid)] { state->WriterGone(id); });
        };
        o.rhc_ops.relinquish_ownership = [](ddsi_rhc *, std::uint64_t) {};
        o.rhc_ops.set_qos = [](ddsi_rhc *, const dds_qos *) {};
        o.rhc_ops.free = [](ddsi_rhc *cache) { delete CacheOf(cache); };
        o.read = o.take = [](dds_rhc *, bool, void **, dds_sample_info_t *, std::uint32_t, std::uint32_t,
                             dds_instance_handle_t, dds_readcond *) -> std::int32_t { return 0; };
        o.readcdr = o.takecdr = [](dds_rhc *, bool, ddsi_serdata **, dds_sample_info_t *, std::uint32_t,
                                   std::uint32_t, std::uint32_t, std::uint32_t,
                                   dds_instance_handle_t) -> std::int32_t { return 0; };
        o.add_readcondition = [](dds_rhc *, dds_readcond *) { return false; };
        o.remove_readcondition = [](dds_rhc *, dds_readcond *) {};
        o.lock_samples = [](dds_rhc *) -> std::uint32_t { return 0; };
        o.associate = [](dds_rhc *, dds_reader *, const ddsi_sertype *, ddsi_tkmap *) -> dds_return_t
        { return DDS_RETCODE_OK; };
        return o;
    }();
    return ops;
}

class CycloneReader final : public TransportReader
{
public:
    CycloneReader(const std::shared_ptr<Core> &core, const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions, SampleHandler handler)
        : _use(core->Topics, topic),
          _entityTopic(MakeTopic(*core, topic, _type)),
          _state(std::make_shared<ReaderState>(core, topic, std::move(handler)))
    {
        auto *cache = new PassingCache{};
        cache->Base.common.ops = &CacheOps();
        cache->State = _state;
        dds_qos_t *settings = MakeQos(qos, partitions, false);
        dds_listener_t *listener = dds_create_listener(_state.get());
        dds_lset_requested_incompatible_qos(
            listener,
            [](dds_entity_t, const dds_requested_incompatible_qos_status_t, void *self)
            {
                const auto *state = static_cast<ReaderState *>(self);
                state->Session->Log->IncompatibleQos(state->Topic.Name);
            });
        dds_lset_sample_lost(listener,
                             [](dds_entity_t, const dds_sample_lost_status_t status, void *self)
                             {
                                 static_cast<ReaderState *>(self)->Session->Log->SamplesLost(
                                     static_cast<std::uint64_t>(status.total_count_change));
                             });
        _reader = dds_create_reader_rhc(core->Participant, _entityTopic, settings, listener, &cache->Base);
        dds_delete_listener(listener);
        dds_delete_qos(settings);
        if (_reader < 0)
        {
            dds_delete(_entityTopic);
            throw TransportError("Cyclone DDS cannot make a reader of topic " + topic.Name + ": " +
                                 dds_strretcode(_reader));
        }
    }
    ~CycloneReader() override
    {
        _state->Gate.Close();
        dds_delete(_reader);
        dds_delete(_entityTopic);
    }
    int MatchedWriters() const override
    {
        dds_subscription_matched_status_t status{};
        dds_get_subscription_matched_status(_reader, &status);
        return static_cast<int>(status.current_count);
    }

private:
    const TopicRegistry::Use _use;
    const ddsi_sertype *_type = nullptr;
    const dds_entity_t _entityTopic;
    const std::shared_ptr<ReaderState> _state;
    dds_entity_t _reader = 0;
};

class CycloneSession final : public TransportSession
{
public:
    CycloneSession(const TransportSettings &settings, PeerHandler onPeer)
        : _core(std::make_shared<Core>(settings, std::move(onPeer)))
    {
    }
    ~CycloneSession() override { _core->Close(); }
    std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions) override
    {
        CheckQos(topic, qos);
        return std::make_unique<CycloneWriter>(_core, topic, qos, partitions);
    }
    std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                  const std::vector<std::string> &partitions,
                                                  SampleHandler handler) override
    {
        CheckQos(topic, qos);
        return std::make_unique<CycloneReader>(_core, topic, qos, partitions, std::move(handler));
    }
    TransportCounters Counters() const override { return _core->Log->Read(); }

private:
    const std::shared_ptr<Core> _core;
};

}  // namespace

std::string CycloneDdsTransport::Name() const
{
    return "cyclonedds";
}

std::unique_ptr<TransportSession> CycloneDdsTransport::Open(const TransportSettings &settings,
                                                            PeerHandler onPeer)
{
    return std::make_unique<CycloneSession>(settings, std::move(onPeer));
}

}  // namespace Rabit
