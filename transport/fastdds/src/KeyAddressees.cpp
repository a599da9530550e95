#include "KeyAddressees.h"

#include <algorithm>
#include <mutex>
#include <utility>

namespace Rabit::FastDds
{

namespace
{

// OMG DDS Security 1.1, 7.4.5
constexpr Rtps::EntityId KeyWriter = 0xff0202c3;  // BuiltinParticipantVolatileMessageSecureWriter
constexpr Rtps::EntityId KeyReader = 0xff0202c4;
constexpr Rtps::EntityId SecurePublicationsWriter = 0xff0003c2;  // SEDPbuiltinPublicationsSecureWriter
constexpr Rtps::EntityId SecurePublicationsReader = 0xff0003c7;
constexpr Rtps::EntityId SecureSubscriptionsWriter = 0xff0004c2;

bool AreMatched(const rtps::GUID_t &writer, const rtps::GUID_t &reader)
{
    rtps::RTPSWriter *const found = FindWriter(writer);
    return found != nullptr && found->matched_reader_is_matched(reader);
}

}  // namespace

bool KeyAddressees::IsAuthenticated(const Rtps::GuidPrefix &own, const Rtps::GuidPrefix &peer)
{
    // The vendor matches them at the end of the handshake.
    return AreMatched(GuidOf(own, KeyWriter), GuidOf(peer, KeyReader));
}

bool KeyAddressees::HasKeysOf(const Rtps::GuidPrefix &own, const Rtps::GuidPrefix &peer)
{
    // The vendor matches them when it has the keys of both.
    return AreMatched(GuidOf(own, SecurePublicationsWriter), GuidOf(peer, SecurePublicationsReader));
}

bool KeyAddressees::Heed(const rtps::RTPSParticipant &participant)
{
    static KeyAddressees addressees;
    rtps::RTPSWriter *const writer = FindWriter({participant.getGuid().guidPrefix, KeyWriter});
    if (writer == nullptr)
    {
        return false;
    }
    // The vendor calls a filter with this lock held.
    const std::lock_guard lock(writer->getMutex());
    writer->reader_data_filter(&addressees);
    return true;
}

void KeyAddressees::SetPeriods(const rtps::RTPSParticipant &participant, bool isSettled)
{
    const Duration soon{0, 250'000'000};
    const Duration calm{2, 0};
    const std::pair<Rtps::EntityId, Duration> writers[] = {
        {SecurePublicationsWriter, isSettled ? calm : soon},
        {SecureSubscriptionsWriter, isSettled ? calm : soon},
        {KeyWriter, soon}};
    for (const auto &[entity, period] : writers)
    {
        if (rtps::RTPSWriter *const writer = FindWriter({participant.getGuid().guidPrefix, entity}))
        {
            SetHeartbeatPeriod(*writer, period);
        }
    }
}

bool KeyAddressees::is_relevant(const rtps::CacheChange_t &change, const rtps::GUID_t &reader) const
{
    // 7.4.4.1: offset of the addressee of a sample. Before it are the CDR header, the message's identity and
    // that of the message it answers, each a GUID and a number.
    constexpr std::size_t addresseeAt = 4 + 2 * (16 + 8);
    const auto &payload = change.serializedPayload;
    const auto &prefix = reader.guidPrefix.value;
    return payload.length < addresseeAt + sizeof(prefix) ||
           std::equal(std::begin(prefix), std::end(prefix), payload.data + addresseeAt);
}

}  // namespace Rabit::FastDds
