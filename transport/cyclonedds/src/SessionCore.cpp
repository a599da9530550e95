#include "SessionCore.h"

#include <arpa/inet.h>

#include <string>
#include <utility>

#include "RemoteParticipant.h"
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

Entity MakeParticipant(const TransportSettings &settings, dds_domainid_t domain, bool hasCard)
{
    const Qos qos = MakeQos();
    dds_qset_entity_name(qos.get(), settings.Node.c_str());
    const std::string data = MakeUserData(settings.Incarnation, hasCard);
    dds_qset_userdata(qos.get(), data.data(), data.size());
    return {dds_create_participant(domain, qos.get(), nullptr),
            "join domain " + std::to_string(settings.Domain)};
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
    _domain.Begin(_own);
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
    Appeared(prefix, announced, PlaceOf(prefix));
}

void SessionCore::PeerGone(const Rtps::GuidPrefix &prefix)
{
    const ddsi_guid_t participant = ParticipantOf(prefix);
    const bool isSilent = RabitCycloneLeaseHasExpired(&participant) || _domain.WasEnded(prefix);
    _domain.Gone(prefix);
    const auto how = isSilent ? PeerEvent::Kind::Lost : PeerEvent::Kind::Left;
    if (how == PeerEvent::Kind::Lost)
    {
        _accounts->Left(prefix);
        _domain.Lost(prefix);
    }
    Gone(prefix, how);
}

}  // namespace Rabit::Cyclone
