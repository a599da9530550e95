// The vendor's number of a participant within this process, and its GUID prefix.
//
// Left to the vendor, each participant of a process gets the next number, and with it the next ports, whether
// those before it live or not: a session that joins the network anew would move out of the reach of those who
// look for it at a given port, and run out of ports in the end. But the vendor makes the prefix of the number,
// and a prefix belongs to one life of one participant. So both are given.
#pragma once

#include <fastdds/rtps/common/GuidPrefix_t.hpp>

#include <cstdint>

namespace Rabit::FastDds
{

// The smallest number that no other lives with. The ports begin with it; those that another process has are
// skipped by the vendor. Any thread.
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

// One that no other participant has or had. Begins as the vendor's do (OMG DDSI-RTPS 2.3, 9.3.1.5).
eprosima::fastrtps::rtps::GuidPrefix_t MakeGuidPrefix();

}  // namespace Rabit::FastDds
