#include "Guid.h"

#include <arpa/inet.h>
#include <dds/ddsi/q_rtps.h>

#include <cstdint>
#include <cstring>

namespace Rabit::Cyclone
{

// The vendor keeps GUIDs as numbers in the host's byte order.
WriterId ToWriterId(const ddsi_guid_t &guid)
{
    const std::uint32_t parts[4] = {htonl(guid.prefix.u[0]), htonl(guid.prefix.u[1]), htonl(guid.prefix.u[2]),
                                    htonl(guid.entityid.u)};
    WriterId id;
    std::memcpy(id.data(), parts, sizeof parts);
    return id;
}

WriterId ToWriterId(const dds_guid_t &guid)
{
    WriterId id;
    std::memcpy(id.data(), guid.v, id.size());
    return id;
}

ddsi_guid_t ToVendorGuid(const WriterId &id)
{
    std::uint32_t parts[4];
    std::memcpy(parts, id.data(), sizeof parts);
    ddsi_guid_t guid;
    for (std::size_t i = 0; i < 3; ++i)
    {
        guid.prefix.u[i] = ntohl(parts[i]);
    }
    guid.entityid.u = ntohl(parts[3]);
    return guid;
}

ddsi_guid_t ParticipantOf(const Rtps::GuidPrefix &prefix)
{
    ddsi_guid_t guid;
    std::memcpy(guid.prefix.u, prefix.data(), prefix.size());
    for (auto &part : guid.prefix.u)
    {
        part = ntohl(part);
    }
    guid.entityid.u = NN_ENTITYID_PARTICIPANT;
    return guid;
}

}  // namespace Rabit::Cyclone
