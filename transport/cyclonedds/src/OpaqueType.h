// Samples and topic types as Cyclone DDS sees them: encoded bytes, a key hash, and nothing else.
#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <memory>

#include "KeptInstance.h"
#include "common/SessionLog.h"

namespace Rabit::Cyclone
{

// Bits of ddsi_serdata::statusinfo, as in the OMG DDSI-RTPS specification 2.3, 9.6.3.9.
constexpr std::uint32_t StatusDisposed = 1;
constexpr std::uint32_t StatusUnregistered = 2;

// A sample, shared with the vendor by a reference count. Header is its first member, as the vendor requires.
// Its bytes follow it in the same memory, aligned to 8.
struct OpaqueSample
{
    ddsi_serdata Header;
    std::size_t Size = 0;
    std::uint32_t Capacity = 0;  // of this memory
    KeyHash Key{};
    std::uint64_t Sequence = 0;  // of an arrived sample

    std::uint8_t *Data() const
    {
        return reinterpret_cast<std::uint8_t *>(const_cast<OpaqueSample *>(this) + 1);
    }
    // At most once for each sample, and only on a topic with a key.
    void SetKey(const KeyHash &key);
};

// Makes a sample with one reference. Its bytes are not initialized.
OpaqueSample *NewSample(const ddsi_sertype *type, ddsi_serdata_kind kind, std::size_t size);

// Makes the type of one topic. Arrivals that are no sample of it are counted in the log. The caller owns one
// reference, which dds_create_topic_sertype takes.
ddsi_sertype *NewType(const TopicDescription &topic, std::shared_ptr<SessionLog> log);

// Keeps the vendor's instance of a topic without a key (RabitCycloneKeepInstance), for as long as a writer or
// reader of it lives. Does nothing for a topic with a key.
class KeptInstance
{
public:
    // The type must be registered with a domain, and outlive this object.
    KeptInstance(const ddsi_sertype *type, const TopicDescription &topic);
    ~KeptInstance();
    KeptInstance(const KeptInstance &) = delete;
    KeptInstance &operator=(const KeptInstance &) = delete;

private:
    const ddsi_sertype *const _type;
    ddsi_tkmap_instance *_instance = nullptr;
};

}  // namespace Rabit::Cyclone
