#include "KeyAddressees.h"

#include <algorithm>
#include <mutex>

namespace Rabit::FastDds
{

bool KeyAddressees::HasKeysOf(const Rtps::GuidPrefix &own, const Rtps::GuidPrefix &peer)
{
    // OMG DDS Security 1.1, 7.4.5: SEDPbuiltinPublicationsSecureWriter and its reader. The vendor matches
    // them when it has the keys of both.
    constexpr rtps::octet secureWriter[] = {0xff, 0x00, 0x03, 0xc2};
    constexpr rtps::octet secureReader[] = {0xff, 0x00, 0x03, 0xc7};
    rtps::GUID_t writer;
    rtps::GUID_t reader;
    std::copy(own.begin(), own.end(), writer.guidPrefix.value);
    std::copy(peer.begin(), peer.end(), reader.guidPrefix.value);
    std::copy(std::begin(secureWriter), std::end(secureWriter), writer.entityId.value);
    std::copy(std::begin(secureReader), std::end(secureReader), reader.entityId.value);
    rtps::RTPSWriter *const found = FindWriter(writer);
    return found != nullptr && found->matched_reader_is_matched(reader);
}

bool KeyAddressees::Heed(const rtps::RTPSParticipant &participant)
{
    // OMG DDS Security 1.1, 7.4.5: BuiltinParticipantVolatileMessageSecureWriter
    constexpr rtps::octet keyWriter[] = {0xff, 0x02, 0x02, 0xc3};
    static KeyAddressees addressees;
    rtps::GUID_t guid = participant.getGuid();
    std::copy(std::begin(keyWriter), std::end(keyWriter), guid.entityId.value);
    rtps::RTPSWriter *const writer = FindWriter(guid);
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
    struct Writer
    {
        rtps::octet Entity[4];
        Duration Period;
    };
    // OMG DDS Security 1.1, 7.4.5: the protected writers of publications and subscriptions, and that of keys.
    const Writer writers[] = {{{0xff, 0x00, 0x03, 0xc2}, isSettled ? calm : soon},
                              {{0xff, 0x00, 0x04, 0xc2}, isSettled ? calm : soon},
                              {{0xff, 0x02, 0x02, 0xc3}, soon}};
    rtps::GUID_t guid = participant.getGuid();
    for (const Writer &each : writers)
    {
        std::copy(std::begin(each.Entity), std::end(each.Entity), guid.entityId.value);
        if (rtps::RTPSWriter *const writer = FindWriter(guid))
        {
            SetHeartbeatPeriod(*writer, each.Period);
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
