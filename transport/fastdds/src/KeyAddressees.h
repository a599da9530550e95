#pragma once

#include "Vendor.h"

#include "common/Rtps.h"

namespace Rabit::FastDds
{

// Sends key-exchange samples only to their addressees. A participant has one reliable writer of keys for all
// other authenticated participants (OMG DDS Security 1.1, 7.4.4), and each sample is for one of them
// (7.4.4.2). The vendor sends each sample to all peers, which ignore those of others: with ten participants
// nine times the traffic needed.
class KeyAddressees final : public rtps::IReaderDataFilter
{
public:
    // Installs the filter in an enabled participant. Returns false, and changes nothing, if its writer of
    // keys is not found.
    static bool Heed(const rtps::RTPSParticipant &participant);
    // Sets how soon the protected writers of an enabled participant repeat heartbeats. The writer of keys
    // does so after 0.25 s, and those of discovery too while exchanges are under way. The vendor's periods
    // are 3 and 1 s, as long as a lost key or endpoint then waits. `isSettled`: KeyExchangeOutbox no longer
    // holds back what is too much. The vendor's heartbeat goes to all readers while one is behind, and all
    // answer. So the writers of discovery repeat it after 2 s. Call without the vendor's locks.
    static void SetPeriods(const rtps::RTPSParticipant &participant, bool isSettled);
    // True if the participant `own` of this process has authenticated `peer`.
    static bool IsAuthenticated(const Rtps::GuidPrefix &own, const Rtps::GuidPrefix &peer);
    // True if the participant `own` of this process and `peer` have each other's keys.
    static bool HasKeysOf(const Rtps::GuidPrefix &own, const Rtps::GuidPrefix &peer);

    bool is_relevant(const rtps::CacheChange_t &change, const rtps::GUID_t &reader) const override;
};

}  // namespace Rabit::FastDds
