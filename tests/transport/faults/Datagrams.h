// Datagrams of published faults of the vendors, each built from its public description alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/Rtps.h"
#include "guard/RtpsBytes.h"

namespace Faults
{

using Rabit::Rtps::LivelinessWriter;
using Rabit::Rtps::ParticipantEntity;
using Rabit::Rtps::ParticipantWriter;
using Rabit::Rtps::PublicationsWriter;
using Rabit::Rtps::SubscriptionsWriter;
using RtpsBytes::Bytes;
using RtpsBytes::GuidPrefix;

// Flags of a DATA submessage with a payload.
constexpr std::uint8_t HasData = 0x05;

struct Fault
{
    std::string Name;
    // "fastdds" or "cyclonedds".
    std::string Vendor;
    // Sent in this order. The first one may be Announcement().
    std::vector<Bytes> Datagrams;
};

// The builtin endpoints of announcements and liveliness (RTPS 2.3, 9.3.2).
constexpr std::uint32_t BuiltinEndpoints = 0x0c3f;
// The parameters of a participant's announcement, with these endpoints and `more`. The vendor's answers go to
// port 9, which discards them.
Bytes Announced(const Bytes &more);

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
Bytes PartitionWithoutAnEnd();            // Fast DDS issue 6437, CVE-2026-55063
Bytes AcknowledgementOfTooManyBits();     // Fast DDS issues 1337 and 1338
// A heartbeat of numbers that its writer has not reached, after an honest one: Fast DDS issue 3931, Cyclone
// DDS issue 1854.
Bytes HonestHeartbeat();
Bytes HeartbeatFarAhead();
Bytes GapFromTheAwaitedNumber();             // GHSA-f4hw-9j9g-j8xj
Bytes GapToTheHighestNumbers();              // GHSA-f4hw-9j9g-j8xj
Bytes SampleOfTheHighestNumbers();           // GHSA-57rp-jm6r-xjw5
Bytes HeartbeatBehindThatSample();           // GHSA-57rp-jm6r-xjw5
Bytes HeartbeatOfTheLastNumber();            // GHSA-6m2p-wjv5-386v
Bytes WriterOfFragments();                   // sound: announces the writer of the four below
Bytes FragmentsWhoseTailIsShort();           // CVE-2025-62799
Bytes FragmentsShorterThanTheVendorsMark();  // CVE-2025-62799
Bytes FragmentWithInlineQosBeyondItsEnd();   // CVE-2025-65865
Bytes LastFragmentWithoutItsBytes();         // CVE-2026-22590

// Announcements that Fast DDS reads (FastDdsAnnouncements.cpp).
Bytes ParticipantAtAnothersAddress();    // CVE-2021-38425
Bytes RepresentationsThatAreNotThere();  // CVE-2026-49861
Bytes DomainsThatAreNotThere();          // CVE-2026-49861
Bytes AddressesThatAreNotThere();        // CVE-2026-53589
Bytes EmptyPropertiesThatAreNotThere();  // CVE-2026-53590
Bytes TypesBehindTheirParameter();       // CVE-2026-49863
Bytes PartitionLongerThanItsList();      // GHSA-8g7x-c9fg-g6mh
Bytes ReaderWithANestedFilter();         // CVE-2026-22591

// Cyclone DDS (CycloneDds.cpp).
Bytes SampleThatEndsBeforeItsInlineQos();  // issue 1555
Bytes LivelinessAsAParameterList();        // issue 1751
Bytes ParticipantWithoutALease();          // issue 1758
Bytes LivelinessOfFourBytes();             // issue 1771
Bytes ParticipantAtPortZero();             // issue 1772
Bytes MessageOfAHeaderAlone();             // issue 2402
Bytes WriterOfAnother();                   // pull request 2335
Bytes LivelinessOfAnother();               // pull request 2335
Bytes GoodbyeOfAnother();                  // pull request 2335

std::vector<Fault> FastDdsFaults();
std::vector<Fault> FastDdsAnnouncementFaults();
std::vector<Fault> CycloneDdsFaults();

}  // namespace Faults
