// The vendor's number of a participant within this process, and its GUID prefix.
//
// The vendor would give each participant of a process the next number, and with it the next ports, even if
// earlier participants are gone. A session that joins the network anew would then leave the ports at which
// peers look for it, and run out of ports in the end. But the vendor also derives the GUID prefix from the
// number, and a prefix belongs to one incarnation of one participant. So this file sets both.
#pragma once

#include <fastdds/rtps/common/GuidPrefix_t.hpp>

#include <cstdint>

namespace Rabit::FastDds
{

// The smallest number that no living object of this process has. The search for ports starts with it; the
// vendor skips ports that another process has. Any thread.
class ParticipantNumber
{
public:
    ParticipantNumber();
    ~ParticipantNumber();
    ParticipantNumber(const ParticipantNumber &) = delete;
    ParticipantNumber &operator=(const ParticipantNumber &) = delete;
    std::int32_t Get() const { return _number; }

private:
    std::int32_t _number = 0;
};

// A prefix that no other participant has or had. Begins as the vendor's do (OMG DDSI-RTPS 2.3, 9.3.1.5).
eprosima::fastrtps::rtps::GuidPrefix_t MakeGuidPrefix();

}  // namespace Rabit::FastDds
