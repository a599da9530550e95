#pragma once

#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/interfaces/IReaderDataFilter.hpp>

namespace Rabit::FastDds
{

// Whom keys go to. There is one writer of them in a participant, reliable, for all others that are
// authenticated (OMG DDS Security 1.1, 7.4.4), and each sample is for one of them (7.4.4.2). The vendor sends
// each to all, who pass over what is not for them: with ten participants nine times as much as is needed.
class KeyAddressees final : public eprosima::fastdds::rtps::IReaderDataFilter
{
public:
    // Of that participant, which is enabled. False if its writer of keys is not found: it goes on as it is.
    static bool Heed(const eprosima::fastrtps::rtps::RTPSParticipant &participant);

    bool is_relevant(const eprosima::fastrtps::rtps::CacheChange_t &change,
                     const eprosima::fastrtps::rtps::GUID_t &reader) const override;
};

}  // namespace Rabit::FastDds
