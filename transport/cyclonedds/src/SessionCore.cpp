#include "SessionCore.h"

#include <arpa/inet.h>

#include <string>
#include <utility>

#include "RemoteParticipant.h"
#include "VendorLog.h"
#include "common/RtpsReader.h"

namespace Rabit::Cyclone
{

namespace
{

// Time from a newcomer to our answer: 50 to 150 ms, depending on the name, so that not all nodes answer at
// once.
std::chrono::milliseconds AnswerGap(const TransportSettings &settings)
{
    return std::chrono::milliseconds(50 + std::hash<std::string>()(settings.Node) % 100);
}

// The vendor's security plugins are libraries that it loads by name.
void AddSecurity(const TransportSecurity &security, dds_qos_t *qos)
{
    const auto add = [&](const std::string &name, const std::string &value)
    { dds_qset_prop(qos, name.c_str(), value.c_str()); };
    const auto addLibrary = [&](const std::string &part, const std::string &file, const std::string &function)
    {
        const std::string library = "dds.sec." + part + ".library.";
        add(library + "path", "dds_security_" + file);
        add(library + "init", "init_" + function);
        add(library + "finalize", "finalize_" + function);
    };
    addLibrary("auth", "auth", "authentication");
    addLibrary("access", "ac", "access_control");
    addLibrary("crypto", "crypto", "crypto");
    add("dds.sec.auth.identity_ca", "file:" + security.IdentityAuthority);
    add("dds.sec.auth.identity_certificate", "file:" + security.Certificate);
    add("dds.sec.auth.private_key", "file:" + security.PrivateKey);
    if (!security.Revoked.empty())
    {
        add("org.eclipse.cyclonedds.sec.auth.crl", "file:" + security.Revoked);
    }
    add("dds.sec.access.permissions_ca", "file:" + security.PermissionsAuthority);
    add("dds.sec.access.governance", "file:" + security.Governance);
    add("dds.sec.access.permissions", "file:" + security.Permissions);
}

Entity MakeParticipant(const TransportSettings &settings, dds_domainid_t domain, bool hasCard)
{
    const Qos qos = MakeQos();
    dds_qset_entity_name(qos.get(), settings.Node.c_str());
    const std::string data = MakeUserData(settings.Incarnation, hasCard);
    dds_qset_userdata(qos.get(), data.data(), data.size());
    if (settings.Security)
    {
        AddSecurity(*settings.Security, qos.get());
    }
    const std::string what = "join domain " + std::to_string(settings.Domain);
    if (!settings.Security)
    {
        return {dds_create_participant(domain, qos.get(), nullptr), what};
    }
    const VendorLogCapture capture;
    const dds_entity_t participant = dds_create_participant(domain, qos.get(), nullptr);
    return {participant, capture.FirstLine().empty() ? what : what + ": " + capture.FirstLine()};
}

// Call only from a listener of a built-in topic.
PeerPlace PlaceOf(const Rtps::GuidPrefix &prefix)
{
    PeerPlace place;
    const ddsi_guid_t participant = ParticipantOf(prefix);
    RabitCyclonePeerAddresses(
        &participant,
        [](const RabitCyclonePlace *found, void *argument)
        {
            char text[INET_ADDRSTRLEN] = "";
            inet_ntop(AF_INET, found->address, text, sizeof text);
            static_cast<PeerPlace *>(argument)->push_back(text);
        },
        &place);
    return place;
}

// Calls work(sample, info) with each sample of a built-in topic.
template <typename Sample, typename Work>
void TakeAll(dds_entity_t reader, const Work &work)
{
    void *values[1] = {nullptr};
    dds_sample_info_t info;
    while (dds_take(reader, values, &info, 1, 1) == 1)
    {
        work(*static_cast<const Sample *>(values[0]), info);
        dds_return_loan(reader, values, 1);
        values[0] = nullptr;
    }
}

RemoteEndpoint Described(const dds_builtintopic_endpoint_t &announced, const WriterId &id, bool isWriter,
                         const std::string &node)
{
    RemoteEndpoint endpoint{.Id = id,
                            .IsWriter = isWriter,
                            .Topic = announced.topic_name,
                            .Type = announced.type_name,
                            .Node = node};
    dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
    if (dds_qget_reliability(announced.qos, &reliability, nullptr) && reliability == DDS_RELIABILITY_RELIABLE)
    {
        endpoint.Reliability = Reliability::Reliable;
    }
    dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
    if (dds_qget_durability(announced.qos, &durability) && durability != DDS_DURABILITY_VOLATILE)
    {
        endpoint.Durability = Durability::TransientLocal;
    }
    dds_duration_t period = DDS_INFINITY;
    endpoint.HasDeadline = dds_qget_deadline(announced.qos, &period) && period != DDS_INFINITY;
    dds_liveliness_kind_t liveliness = DDS_LIVELINESS_AUTOMATIC;
    dds_duration_t lease = DDS_INFINITY;
    endpoint.HasLiveliness = dds_qget_liveliness(announced.qos, &liveliness, &lease) &&
                             (liveliness != DDS_LIVELINESS_AUTOMATIC || lease != DDS_INFINITY);
    dds_ownership_kind_t ownership = DDS_OWNERSHIP_SHARED;
    endpoint.IsExclusive =
        dds_qget_ownership(announced.qos, &ownership) && ownership == DDS_OWNERSHIP_EXCLUSIVE;
    std::uint32_t count = 0;
    char **names = nullptr;
    if (dds_qget_partition(announced.qos, &count, &names))
    {
        for (std::uint32_t i = 0; i < count; ++i)
        {
            endpoint.Partitions.emplace_back(names[i]);
            dds_free(names[i]);
        }
        dds_free(names);
    }
    return endpoint;
}

}  // namespace

SessionCore::SessionCore(const TransportSettings &settings, const SessionContext &context)
    : VendorCore(settings, context),
      _domain(settings, Log(), context.Turns, context.Sending, _goodbyes, _accounts),
      _announcements(AnswerGap(settings), _domain.HasCard()),
      _participant(MakeParticipant(settings, _domain.Id(), _domain.HasCard()))
{
    if (settings.SharedMemory)
    {
        Log()->Line("Cyclone DDS shares memory only through a daemon of its own: UDP is used");
    }
    dds_guid_t guid;
    dds_get_guid(_participant.Get(), &guid);
    _own = Rtps::PrefixOf(ToWriterId(guid));
    const auto watch = [this](dds_entity_t topic, dds_on_data_available_fn onData)
    {
        const Listener listener = MakeListener(this);
        dds_lset_data_available(listener.get(), onData);
        // The participant owns it.
        const dds_entity_t reader = dds_create_reader(Participant(), topic, nullptr, listener.get());
        if (reader < 0)
        {
            throw TransportError(std::string("Cyclone DDS cannot watch its discovery: ") +
                                 dds_strretcode(reader));
        }
    };
    watch(DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, &OnParticipants);
    watch(DDS_BUILTIN_TOPIC_DCPSPUBLICATION, &OnEndpoints<true>);
    watch(DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, &OnEndpoints<false>);
    const ddsi_guid_t own = ParticipantOf(_own);
    _announcements.Start({.IsUnheard = [this, own] { return _domain.IsUnheard(own); },
                          .Announce = [this, own] { _domain.Announce(own); }});
}

SessionCore::~SessionCore()
{
    Close();
}

void SessionCore::OnParticipants(dds_entity_t reader, void *self)
{
    auto &core = *static_cast<SessionCore *>(self);
    TakeAll<dds_builtintopic_participant_t>(reader,
                                            [&](const auto &peer, const dds_sample_info_t &info)
                                            {
                                                const auto prefix = Rtps::PrefixOf(ToWriterId(peer.key));
                                                if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
                                                {
                                                    core.PeerGone(prefix);
                                                }
                                                else if (info.valid_data)
                                                {
                                                    core._domain.Came(prefix);
                                                    if (!core._domain.IsReplayed(prefix))
                                                    {
                                                        core._announcements.OnPeer();
                                                    }
                                                    core.PeerAppeared(prefix, peer.qos);
                                                }
                                            });
}

template <bool isWriter>
void SessionCore::OnEndpoints(dds_entity_t reader, void *self)
{
    auto &core = *static_cast<SessionCore *>(self);
    TakeAll<dds_builtintopic_endpoint_t>(
        reader,
        [&](const auto &endpoint, const dds_sample_info_t &info)
        {
            const WriterId id = ToWriterId(endpoint.key);
            if (info.instance_state != DDS_ALIVE_INSTANCE_STATE)
            {
                core.Topics().RemoteGone(id);
            }
            else if (info.valid_data && Rtps::PrefixOf(id) != core._own)
            {
                const auto identity = core.IdentityOf(id);
                core.Topics().RemoteAppeared(
                    Described(endpoint, id, isWriter, identity != nullptr ? identity->Node : ""));
            }
        });
}

void SessionCore::PeerAppeared(const Rtps::GuidPrefix &prefix, const dds_qos_t *qos)
{
    void *data = nullptr;
    std::size_t size = 0;
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
    char *name = nullptr;
    dds_qget_entity_name(qos, &name);
    const ParticipantIdentity announced{name != nullptr ? name : "", *incarnation};
    dds_free(name);
    // The vendor may have read a datagram before its sockets were watched.
    if (!_domain.MayBe(prefix, announced.Node))
    {
        Log()->Impostor(announced.Node);
        return;
    }
    Appeared(prefix, announced, PlaceOf(prefix));
}

void SessionCore::PeerGone(const Rtps::GuidPrefix &prefix)
{
    const ddsi_guid_t participant = ParticipantOf(prefix);
    const bool isForgotten = _domain.WasForgotten(prefix);
    const bool isSilent =
        RabitCycloneLeaseHasExpired(&participant) || _domain.WasEnded(prefix) || isForgotten;
    _domain.Gone(prefix);
    const auto how = isSilent ? PeerEvent::Kind::Lost : PeerEvent::Kind::Left;
    if (how == PeerEvent::Kind::Lost)
    {
        _accounts->Left(prefix);
        _domain.Lost(prefix);
    }
    const auto session = Gone(prefix, how);
    if (isForgotten)
    {
        Log()->AuthenticationFailed(session != nullptr ? session->Node : "");
    }
}

}  // namespace Rabit::Cyclone
