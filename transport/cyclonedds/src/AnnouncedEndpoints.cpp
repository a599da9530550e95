#include "AnnouncedEndpoints.h"

#include <algorithm>
#include <cstddef>

#include "common/ParticipantIdentity.h"
#include "common/RtpsWriter.h"
#include "guard/DeliveryCheck.h"

namespace Rabit::Cyclone
{

namespace
{

using namespace Rtps;

// OMG DDSI-RTPS 2.3, 9.6.2.2.1 and OMG DDS-XTypes 1.3, 7.6.3.3.5: bits of the set of endpoints.
constexpr std::uint32_t Liveliness = 1u << 10 | 1u << 11;
constexpr std::uint32_t TypeLookup = 1u << 12 | 1u << 13 | 1u << 14 | 1u << 15;

// This vendor announces in little-endian.
std::uint32_t Number(std::span<const std::uint8_t> bytes)
{
    return RtpsReader(bytes, true).U32();
}

bool IsOfRabitNode(std::span<const std::uint8_t> userData)
{
    return userData.size() >= 4 &&
           ParseUserData(userData.subspan(4, std::min<std::size_t>(Number(userData), userData.size() - 4)))
               .has_value();
}

// Changes the parameters in the announcement of a participant.
bool LeaveOut(std::span<std::uint8_t> payload)
{
    std::span<std::uint8_t> set;
    bool isOfRabitNode = false;
    VisitParameters(payload,
                    [&](const ListParameter &parameter)
                    {
                        if (parameter.Id == Parameters::BuiltinEndpointSet && parameter.Value.size() == 4)
                        {
                            set = payload.subspan(EncapsulationSize + parameter.At + 4, 4);
                        }
                        isOfRabitNode = isOfRabitNode || (parameter.Id == Parameters::UserData &&
                                                          IsOfRabitNode(parameter.Value));
                    });
    if (set.empty() || !isOfRabitNode)
    {
        return false;
    }
    const std::uint32_t left = Number(set) & ~(Liveliness | TypeLookup);
    const bool changed = left != Number(set);
    Write(set, left, true);
    return changed;
}

}  // namespace

bool LeaveOutIdleEndpoints(std::span<std::uint8_t> datagram)
{
    bool changed = false;
    VisitSubmessages(datagram,
                     [&changed](const Submessage &submessage)
                     {
                         const auto said = submessage.Kind == SubmessageKind::Data ? CheckDelivery(submessage)
                                                                                   : std::nullopt;
                         // A goodbye has a key alone.
                         if (said && said->Writer == ParticipantWriter && !said->HasKeyPayload &&
                             said->Payload.size() >= EncapsulationSize && IsLittleEndianList(said->Payload))
                         {
                             changed = LeaveOut(said->Payload) || changed;
                         }
                     });
    return changed;
}

}  // namespace Rabit::Cyclone
