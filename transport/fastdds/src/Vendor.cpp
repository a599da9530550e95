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
class BaseReader;
// Begins so in version 3.1.
struct LocalReader
{
    BaseReader *Reader;
};
class RTPSDomainImpl
{
public:
    // Finds a writer of a participant of this process, builtin ones included; nullptr if there is none.
    static BaseWriter *find_local_writer(const GUID_t &guid);
    // The same of a reader.
    static std::shared_ptr<LocalReader> find_local_reader(const GUID_t &guid);
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

namespace
{

// Matches a builtin reader of this process with a builtin writer of a peer, as long as the object lives. The
// reader's participant must outlive it: ~SessionCore stops its threads before it removes the participant.
class BuiltinMatch
{
public:
    BuiltinMatch(const rtps::GUID_t &reader, const rtps::GUID_t &writer) : _writer(writer)
    {
        const auto found = rtps::RTPSDomainImpl::find_local_reader(reader);
        if (found == nullptr)
        {
            return;
        }
        // A BaseReader begins with its RTPSReader.
        auto *const local = reinterpret_cast<rtps::RTPSReader *>(found->Reader);
        rtps::PublicationBuiltinTopicData data;
        data.guid = writer;
        data.durability.kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
        // If the vendor itself has matched them, that remains.
        const bool isNew = !local->matched_writer_is_matched(writer) && local->matched_writer_add(data);
        _reader = isNew ? local : nullptr;
    }
    ~BuiltinMatch()
    {
        if (_reader != nullptr)
        {
            _reader->matched_writer_remove(_writer);
        }
    }
    BuiltinMatch(const BuiltinMatch &) = delete;
    BuiltinMatch &operator=(const BuiltinMatch &) = delete;

private:
    rtps::RTPSReader *_reader = nullptr;
    rtps::GUID_t _writer;
};

}  // namespace

void AsProtected(const Rtps::GuidPrefix &own, const Rtps::GuidPrefix &peer,
                 const std::function<void()> &deliver)
{
    constexpr Rtps::EntityId plainReader = 0x000100c7;
    // OMG DDS Security 1.1, 7.4.5: SPDPbuiltinParticipantsSecureWriter and its reader
    constexpr Rtps::EntityId secureWriter = 0xff0101c2;
    constexpr Rtps::EntityId secureReader = 0xff0101c7;
    // With the first match, the reader of plain announcements heeds them. With the second one, the vendor
    // takes the peer for one with protected endpoints.
    const BuiltinMatch plain(GuidOf(own, plainReader), GuidOf(peer, Rtps::ParticipantWriter));
    const BuiltinMatch secure(GuidOf(own, secureReader), GuidOf(peer, secureWriter));
    deliver();
}

void ReadInterfaces()
{
    eprosima::SystemInfo::update_interfaces();
}

#else

void AsProtected(const Rtps::GuidPrefix & /*own*/, const Rtps::GuidPrefix & /*peer*/,
                 const std::function<void()> &deliver)
{
    deliver();
}

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
    // OMG DDSI-RTPS 2.3, 9.3.1.3, and OMG DDS Security 1.1, 7.4.5. The other builtin writers repeat no
    // heartbeats.
    constexpr Rtps::EntityId reliable[] = {Rtps::PublicationsWriter,
                                           Rtps::SubscriptionsWriter,
                                           Rtps::LivelinessWriter,
                                           0xff0003c2,   // SEDPbuiltinPublicationsSecureWriter
                                           0xff0004c2,   // SEDPbuiltinSubscriptionsSecureWriter
                                           0xff0101c2,   // SPDPbuiltinParticipantsSecureWriter
                                           0xff0200c2,   // BuiltinParticipantMessageSecureWriter
                                           0xff0202c3};  // BuiltinParticipantVolatileMessageSecureWriter
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
