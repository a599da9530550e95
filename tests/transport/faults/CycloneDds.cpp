// Published faults of Cyclone DDS.
#include "faults/Datagrams.h"

namespace Faults
{

using namespace RtpsBytes;

namespace
{

constexpr EntityId LivelinessReader = 0x000200c7;

Bytes Liveliness(const Bytes &payload)
{
    return Message(Data, DataBody(1, payload, LivelinessWriter, LivelinessReader), HasData);
}

}  // namespace

// The submessage reaches to the end of the message, which comes in the middle of the sample's number. Its
// flags say that inline QoS follows. No entity in it is a writer.
Bytes SampleThatEndsBeforeItsInlineQos()
{
    constexpr std::uint8_t Flags = 0xf2;  // inline QoS, big-endian
    return Join({Header(), {Data, Flags, 0, 0}, Bytes(4), {0, 0x13, 0x70, 0}, Bytes(4), {1, 0, 0, 0}});
}

// A parameter list, where a sample of liveliness is plain CDR.
Bytes LivelinessAsAParameterList()
{
    return Liveliness(ParticipantData());
}

// The list has all parameters of a participant but its lease.
Bytes ParticipantWithoutALease()
{
    return Message(Data,
                   DataBody(2,
                            List({Parameter(0x0015, {2, 3, 0, 0}), Parameter(0x0016, {1, 15, 0, 0}),
                                  Parameter(0x0050, Guid(Sender, ParticipantEntity)),
                                  Parameter(0x0032, Join({U32(1), U32(9), Bytes(12), {127, 0, 0, 1}})),
                                  Parameter(0x0031, Join({U32(1), U32(9), Bytes(12), {127, 0, 0, 1}})),
                                  Parameter(0x0058, U32(0x0c3f))}),
                            ParticipantWriter),
                   HasData);
}

// Nothing follows the encapsulation.
Bytes LivelinessOfFourBytes()
{
    return Liveliness({0, 0, 0xa4, 0x81});
}

// The second announcement of a participant names a port that does not exist, for discovery.
Bytes ParticipantAtPortZero()
{
    return Join(
        {Header(), Submessage(Data, DataBody(2, ParticipantData(Sender, 0), ParticipantWriter), HasData)});
}

// The vendor looks for a submessage behind the header.
Bytes MessageOfAHeaderAlone()
{
    return Header();
}

Bytes WriterOfAnother()
{
    return Message(Data, DataBody(1, WriterData(UserWriter, Other), PublicationsWriter), HasData);
}

Bytes LivelinessOfAnother()
{
    const Bytes automatic = {0, 0, 0, 1};
    return Liveliness(Join({{0, 1, 0, 0}, Bytes(Other.begin(), Other.end()), automatic, U32(0)}));
}

Bytes GoodbyeOfAnother()
{
    constexpr std::uint8_t OnlyInlineQos = 0x03;
    return Message(Data,
                   DataBody(3,
                            Join({Parameter(0x0070, Guid(Other, ParticipantEntity)),
                                  Parameter(0x0071, {0, 0, 0, 3}),
                                  {1, 0, 0, 0}}),
                            ParticipantWriter),
                   OnlyInlineQos);
}

std::vector<Fault> CycloneDdsFaults()
{
    const auto of = [](const char *name, std::vector<Bytes> datagrams)
    { return Fault{.Name = name, .Vendor = "cyclonedds", .Datagrams = std::move(datagrams)}; };
    return {
        of("issue-1555", {SampleThatEndsBeforeItsInlineQos()}),
        of("issue-1751", {Announcement(), LivelinessAsAParameterList()}),
        of("issue-1758", {ParticipantWithoutALease()}),
        of("issue-1771", {Announcement(), LivelinessOfFourBytes()}),
        of("issue-1772", {Announcement(), ParticipantAtPortZero()}),
        of("issue-1854", {Announcement(), HonestHeartbeat(), HeartbeatFarAhead()}),
        of("issue-2402", {MessageOfAHeaderAlone()}),
        of("pull-request-2335",
           {Announcement(), WriterOfAnother(), LivelinessOfAnother(), GoodbyeOfAnother()}),
    };
}

}  // namespace Faults
