// The vendor as the rest of this folder uses it. Its versions 2 (Debian 12) and 3 (Debian 13) differ in
// namespaces, headers, names and a few signatures. This file, Vendor2.h and Vendor3.h give both the same
// face:
//
// - `rtps` and `dds`: the vendor's namespaces
// - ParticipantEvents, WriterEvents, ReaderEvents: listeners
// - SentHistory, Buffers, ChainedUdp: bases of a writer's history, a payload pool and a transport
// - functions for what the two versions name differently
//
// All other files are the same for both versions.
#pragma once

#if RABIT_FASTDDS_MAJOR >= 3
#include <fastdds/dds/publisher/qos/WriterQos.hpp>
#include <fastdds/dds/subscriber/qos/ReaderQos.hpp>
#include <fastdds/rtps/RTPSDomain.hpp>
#include <fastdds/rtps/attributes/HistoryAttributes.hpp>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.hpp>
#include <fastdds/rtps/attributes/ReaderAttributes.hpp>
#include <fastdds/rtps/attributes/WriterAttributes.hpp>
#include <fastdds/rtps/builtin/data/ParticipantBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/PublicationBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/SubscriptionBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/TopicDescription.hpp>
#include <fastdds/rtps/common/CacheChange.hpp>
#include <fastdds/rtps/common/Guid.hpp>
#include <fastdds/rtps/common/InstanceHandle.hpp>
#include <fastdds/rtps/common/MatchingInfo.hpp>
#include <fastdds/rtps/common/VendorId_t.hpp>
#include <fastdds/rtps/common/WriteParams.hpp>
#include <fastdds/rtps/history/IPayloadPool.hpp>
#include <fastdds/rtps/history/ReaderHistory.hpp>
#include <fastdds/rtps/history/WriterHistory.hpp>
#include <fastdds/rtps/interfaces/IReaderDataFilter.hpp>
#include <fastdds/rtps/participant/RTPSParticipant.hpp>
#include <fastdds/rtps/participant/RTPSParticipantListener.hpp>
#include <fastdds/rtps/reader/RTPSReader.hpp>
#include <fastdds/rtps/reader/ReaderListener.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.hpp>
#include <fastdds/rtps/transport/SenderResource.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>
#include <fastdds/rtps/writer/RTPSWriter.hpp>
#include <fastdds/rtps/writer/WriterListener.hpp>
#include <fastdds/utils/IPLocator.hpp>

namespace Rabit::FastDds
{
namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;
using Duration = dds::Duration_t;
using RecursiveTimedMutex = eprosima::fastdds::RecursiveTimedMutex;
}  // namespace Rabit::FastDds
#else
#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/attributes/HistoryAttributes.h>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <fastdds/rtps/attributes/ReaderAttributes.h>
#include <fastdds/rtps/attributes/WriterAttributes.h>
#include <fastdds/rtps/builtin/data/ParticipantProxyData.h>
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>
#include <fastdds/rtps/builtin/data/WriterProxyData.h>
#include <fastdds/rtps/common/CacheChange.h>
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/common/MatchingInfo.h>
#include <fastdds/rtps/common/WriteParams.h>
#include <fastdds/rtps/history/IPayloadPool.h>
#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastdds/rtps/history/WriterHistory.h>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/participant/RTPSParticipantListener.h>
#include <fastdds/rtps/reader/RTPSReader.h>
#include <fastdds/rtps/reader/ReaderListener.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastdds/rtps/writer/RTPSWriter.h>
#include <fastdds/rtps/writer/WriterListener.h>
#include <fastrtps/attributes/TopicAttributes.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/publisher/qos/WriterQos.hpp>
#include <fastdds/dds/subscriber/qos/ReaderQos.hpp>
#include <fastdds/rtps/common/VendorId_t.hpp>
#include <fastdds/rtps/interfaces/IReaderDataFilter.hpp>

namespace Rabit::FastDds
{
namespace dds = eprosima::fastdds::dds;
namespace rtps
{
using namespace eprosima::fastdds::rtps;
using namespace eprosima::fastrtps::rtps;
using Locators = eprosima::fastdds::rtps::Locators;
using LocatorsIterator = eprosima::fastdds::rtps::LocatorsIterator;
}  // namespace rtps
using Duration = eprosima::fastrtps::Duration_t;
using RecursiveTimedMutex = eprosima::fastrtps::RecursiveTimedMutex;
}  // namespace Rabit::FastDds
#endif

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/Ledger.h"
#include "common/Rtps.h"

namespace Rabit::FastDds
{

// The names of a topic, as they are announced.
struct TopicNames
{
    std::string Topic;
    std::string Type;
    bool HasKey = false;
};

// Times of a reliable writer and of a reliable reader.
struct WriterPace
{
    std::uint32_t HeartbeatMs = 0;
    std::uint32_t FirstHeartbeatMs = 0;
    std::uint32_t NackResponseMs = 0;
};
struct ReaderPace
{
    std::uint32_t HeartbeatResponseMs = 0;
    std::uint32_t FirstAcknowledgementMs = 0;
};

inline Duration Milliseconds(std::uint32_t count)
{
    return {static_cast<std::int32_t>(count / 1000), count % 1000 * 1'000'000};
}

enum class ParticipantChange
{
    Present,
    Left,  // it said goodbye
    Lost,  // its lease ran out
};

// The announcement of a participant.
struct ParticipantNews
{
    ParticipantChange Change{};
    rtps::GuidPrefix_t Prefix;
    std::string Name;
    const std::vector<rtps::octet> &UserData;
    const rtps::RemoteLocatorList &Discovery;  // where it takes discovery data
    const rtps::RemoteLocatorList &Samples;    // where it takes samples
};

// The announcement of a writer or a reader.
struct EndpointNews
{
    rtps::GUID_t Guid;
    bool IsWriter = false;
    bool IsRemoved = false;
    std::string Topic;
    std::string Type;
    dds::ReliabilityQosPolicyKind Reliability{};
    dds::DurabilityQosPolicyKind Durability{};
    std::vector<std::string> Partitions;
    bool HasDeadline = false;
    bool HasLiveliness = false;  // other than automatic, or with a lease
    bool IsExclusive = false;
};

// The default participant profile of a profiles file; std::nullopt if the vendor does not accept the file.
// The vendor has one table of profiles for the process: not to be called by two threads at a time.
std::optional<rtps::RTPSParticipantAttributes> LoadProfile(const std::string &file);

// Switches intraprocess delivery off in this process. Call it before a participant is made.
void SwitchIntraprocessOff();

// The IPv4 host of an address of the vendor's; UnknownHost for other kinds.
inline Rtps::HostAddress HostOf(const rtps::Locator_t &locator)
{
    Rtps::HostAddress host = Rtps::UnknownHost;
    if (locator.kind == LOCATOR_KIND_UDPv4)
    {
        std::copy_n(rtps::IPLocator::getIPv4(locator), host.size(), host.begin());
    }
    return host;
}

inline Rtps::Place PlaceOf(const rtps::Locator_t &locator)
{
    return {.Host = HostOf(locator), .Port = static_cast<std::uint16_t>(locator.port)};
}

inline rtps::Locator_t LocatorOf(const Rtps::Place &place)
{
    rtps::Locator_t locator;
    rtps::IPLocator::setIPv4(locator, place.Host.data());
    locator.port = place.Port;
    return locator;
}

inline bool IsGroup(const rtps::Locator_t &locator)
{
    return rtps::IPLocator::isMulticast(locator);
}

// Makes a new participant know the interfaces of now: version 3 reads them once for all participants of a
// process.
void ReadInterfaces();

// A writer of a participant of this process, builtin ones included; nullptr if there is none.
rtps::RTPSWriter *FindWriter(const rtps::GUID_t &guid);

// Removes all samples of the vendor's own reliable writers of a participant, which are of discovery. Call it
// before the participant is removed, when it has no other endpoints. Version 2.9 frees the samples while they
// are in the history, and the writer's timer of heartbeats runs on (KeepLastHistory::RemoveWriter). Call it
// without the vendor's locks.
void RemoveOwnSamples(const rtps::RTPSParticipant &participant);

}  // namespace Rabit::FastDds

#if RABIT_FASTDDS_MAJOR >= 3
#include "Vendor3.h"
#else
#include "Vendor2.h"
#endif

namespace Rabit::FastDds
{

inline void SetPace(rtps::WriterAttributes &attributes, const WriterPace &pace)
{
    TimesOf(attributes) = std::tuple(Milliseconds(pace.HeartbeatMs), Milliseconds(pace.FirstHeartbeatMs),
                                     Milliseconds(pace.NackResponseMs), Duration{0, 0});
}

inline void SetPace(rtps::ReaderAttributes &attributes, const ReaderPace &pace)
{
    TimesOf(attributes) =
        std::tuple(Milliseconds(pace.HeartbeatResponseMs), Milliseconds(pace.FirstAcknowledgementMs));
}

}  // namespace Rabit::FastDds
