#include "Vendor.h"

#if RABIT_FASTDDS_MAJOR >= 3

#include <fastdds/LibrarySettings.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/qos/DomainParticipantExtendedQos.hpp>

// Functions of the library that no installed header declares.
namespace eprosima
{
class SystemInfo
{
public:
    // Reads the interfaces of this machine anew, for participants made later. May be called by any thread.
    static bool update_interfaces();
};
}  // namespace eprosima
namespace eprosima::fastdds::dds::utils
{
void set_attributes_from_qos(rtps::RTPSParticipantAttributes &attributes, const DomainParticipantQos &qos);
}  // namespace eprosima::fastdds::dds::utils
namespace eprosima::fastdds::rtps
{
class BaseWriter;
class RTPSDomainImpl
{
public:
    // Finds a writer of a participant of this process, builtin ones included; nullptr if there is none.
    static BaseWriter *find_local_writer(const GUID_t &guid);
};
}  // namespace eprosima::fastdds::rtps

#else

#include <fastrtps/attributes/LibrarySettingsAttributes.h>
#include <fastrtps/attributes/ParticipantAttributes.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

// A function of the library that no installed header declares.
namespace eprosima::fastrtps::rtps
{
class RTPSDomainImpl
{
public:
    // Finds a writer of a participant of this process, builtin ones included; nullptr if there is none.
    static RTPSWriter *find_local_writer(const GUID_t &guid);
};
}  // namespace eprosima::fastrtps::rtps

#endif

namespace Rabit::FastDds
{

#if RABIT_FASTDDS_MAJOR >= 3

std::optional<rtps::RTPSParticipantAttributes> LoadProfile(const std::string &file)
{
    auto *const factory = dds::DomainParticipantFactory::get_instance();
    dds::DomainParticipantExtendedQos qos;
    if (factory->load_XML_profiles_file(file) != dds::RETCODE_OK ||
        factory->get_participant_extended_qos_from_default_profile(qos) != dds::RETCODE_OK)
    {
        return std::nullopt;
    }
    rtps::RTPSParticipantAttributes attributes;
    dds::utils::set_attributes_from_qos(attributes, qos);
    return attributes;
}

void SwitchIntraprocessOff()
{
    eprosima::fastdds::LibrarySettings library;
    library.intraprocess_delivery = eprosima::fastdds::INTRAPROCESS_OFF;
    rtps::RTPSDomain::set_library_settings(library);
}

void ReadInterfaces()
{
    eprosima::SystemInfo::update_interfaces();
}

#else

std::optional<rtps::RTPSParticipantAttributes> LoadProfile(const std::string &file)
{
    using eprosima::fastrtps::xmlparser::XMLP_ret;
    using eprosima::fastrtps::xmlparser::XMLProfileManager;
    if (XMLProfileManager::loadXMLFile(file) != XMLP_ret::XML_OK)
    {
        return std::nullopt;
    }
    eprosima::fastrtps::ParticipantAttributes profile;
    XMLProfileManager::getDefaultParticipantAttributes(profile);
    return profile.rtps;
}

void SwitchIntraprocessOff()
{
    eprosima::fastrtps::LibrarySettingsAttributes library;
    library.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(library);
}

void ReadInterfaces() {}  // each participant does

#endif

void RemoveOwnSamples(const rtps::RTPSParticipant &participant)
{
    // OMG DDSI-RTPS 2.3, 9.3.1.3. The other builtin writers repeat no heartbeats.
    constexpr Rtps::EntityId reliable[] = {Rtps::PublicationsWriter, Rtps::SubscriptionsWriter,
                                           Rtps::LivelinessWriter};
    for (const Rtps::EntityId entity : reliable)
    {
        if (rtps::RTPSWriter *const writer = FindWriter({participant.getGuid().guidPrefix, entity}))
        {
            RemoveSamples(*writer);
        }
    }
}

rtps::RTPSWriter *FindWriter(const rtps::GUID_t &guid)
{
    // In version 3 a BaseWriter, which begins with its RTPSWriter.
    return reinterpret_cast<rtps::RTPSWriter *>(rtps::RTPSDomainImpl::find_local_writer(guid));
}

}  // namespace Rabit::FastDds
