#pragma once

#include "../RawChannel.h"

#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace Rabit::Bench
{

// A sample as the reader takes it.
struct TakenSample
{
    std::uint64_t Number = 0;
    std::int64_t SentAt = 0;
    std::vector<std::uint8_t> Padding;
};

// Bench::Sample for Fast DDS, with the calls of Fast-CDR that the vendor's generator makes. Writes a
// RawSample, reads a TakenSample.
class SampleType final : public eprosima::fastdds::dds::TopicDataType
{
public:
    explicit SampleType(std::size_t payload);

    bool serialize(void *data, eprosima::fastrtps::rtps::SerializedPayload_t *payload) override;
    bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t *payload, void *data) override;
    std::function<std::uint32_t()> getSerializedSizeProvider(void *data) override;
    void *createData() override { return new TakenSample; }
    void deleteData(void *data) override { delete static_cast<TakenSample *>(data); }
    bool getKey(void *, eprosima::fastrtps::rtps::InstanceHandle_t *, bool) override { return false; }
};

}  // namespace Rabit::Bench
