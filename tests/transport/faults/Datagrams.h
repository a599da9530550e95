// Datagrams of published faults of the vendors, each built from its public description alone.
#pragma once

#include <string>
#include <vector>

#include "guard/RtpsBytes.h"

namespace Faults
{

using RtpsBytes::Bytes;

struct Fault
{
    std::string Name;
    // "fastdds" or "cyclonedds".
    std::string Vendor;
    // Only participants with DDS Security read the field that is wrong.
    bool Keys = false;
    // Sent in this order. The first one may be Announcement().
    std::vector<Bytes> Datagrams;
};

// The parameters of a participant's announcement, with its builtin endpoints (RTPS 2.3, 9.3.2) and `more`.
// The vendor's answers go to port 9, which discards them.
Bytes Announced(std::uint32_t endpoints, const Bytes &more);
// Those of announcements and liveliness.
constexpr std::uint32_t BuiltinEndpoints = 0x0c3f;

// A sound announcement of the participant that sends the others: the vendor then listens to its writers of
// endpoints and of liveliness.
Bytes Announcement();

// Fast DDS, which any participant reads (FastDds.cpp).
Bytes PropertyLongerThanItsList();        // CVE-2023-39946
Bytes PropertiesThatAreNotThere();        // CVE-2023-39947
Bytes DescriptionOfATypeThatIsNone();     // CVE-2023-39945, CVE-2023-39948
Bytes RequestForTypesThatIsNone();        // CVE-2023-39945, CVE-2023-39948
Bytes HeartbeatOfNegativeNumbers();       // CVE-2023-39949
Bytes GapFromNumberZero();                // CVE-2023-39534
Bytes GapThatEndsBeforeItBegins();        // CVE-2023-39534
Bytes SampleWithInlineQosOutside();       // CVE-2023-42459
Bytes FragmentWithInlineQosOutside();     // CVE-2023-50716
Bytes SampleWithInlineQosBeyondItsEnd();  // CVE-2024-28231
Bytes GapOfBillions();                    // CVE-2025-64438
std::vector<Bytes> RisingHeartbeats();    // CVE-2025-65016
Bytes Goodbye();                          // CVE-2023-50257
Bytes PartitionWithoutAnEnd();            // Fast DDS issue 6437
Bytes AcknowledgementOfTooManyBits();     // Fast DDS issues 1337 and 1338
// A heartbeat of numbers that its writer has not reached, after an honest one: Fast DDS issue 3931, Cyclone
// DDS issue 1854.
Bytes HonestHeartbeat();
Bytes HeartbeatFarAhead();

// Fast DDS with DDS Security (FastDdsSecurity.cpp). The first is sound.
Bytes AnnouncementWithTokens();
Bytes TokenOfCountlessProperties();        // CVE-2025-62599
Bytes TokenOfCountlessBinaryProperties();  // CVE-2025-62600
Bytes TokenWithAnEndlessValue();           // CVE-2025-62602
Bytes TokenWithALongValue();               // CVE-2025-64098
Bytes HandshakeOfCountlessTokens();        // CVE-2025-62603
Bytes ShortKeyMaterial();                  // Fast DDS issue 6345

// Cyclone DDS (CycloneDds.cpp).
Bytes SampleThatEndsBeforeItsInlineQos();  // issue 1555
Bytes LivelinessAsAParameterList();        // issue 1751
Bytes ParticipantWithoutALease();          // issue 1758
Bytes LivelinessOfFourBytes();             // issue 1771
Bytes ParticipantAtPortZero();             // issue 1772

std::vector<Fault> FastDdsFaults();
std::vector<Fault> FastDdsSecurityFaults();
std::vector<Fault> CycloneDdsFaults();

}  // namespace Faults
