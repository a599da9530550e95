// Samples and topic types as Cyclone DDS sees them: encoded bytes, a key hash, and nothing else.
#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <rabit/transport/Transport.h>

#include <cstdint>
#include <memory>

#include "common/SessionLog.h"

namespace Rabit::Cyclone
{

// Bits of ddsi_serdata::statusinfo, as in the OMG DDSI-RTPS specification 2.3, 9.6.3.9.
constexpr std::uint32_t StatusDisposed = 1;
constexpr std::uint32_t StatusUnregistered = 2;

// A sample, shared with the vendor by a reference count. Header is its first member, as the vendor requires.
struct OpaqueSample
{
    ddsi_serdata Header;
    std::unique_ptr<std::uint64_t[]> Storage;  // aligned to 8
    std::size_t Size = 0;
    KeyHash Key{};
    std::uint64_t Sequence = 0;  // of an arrived sample

    std::uint8_t *Data() const { return reinterpret_cast<std::uint8_t *>(Storage.get()); }
    // At most once for each sample, and only on a topic with a key.
    void SetKey(const KeyHash &key);
};

// Makes a sample with one reference. Its bytes are not initialized.
OpaqueSample *NewSample(const ddsi_sertype *type, ddsi_serdata_kind kind, std::size_t size);

// Makes the type of one topic. Arrivals that are no sample of it are counted in the log. The caller owns one
// reference, which dds_create_topic_sertype takes.
ddsi_sertype *NewType(const TopicDescription &topic, std::shared_ptr<SessionLog> log);

}  // namespace Rabit::Cyclone
