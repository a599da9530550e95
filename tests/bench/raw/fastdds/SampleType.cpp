#include "SampleType.h"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

namespace Rabit::Bench
{

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using eprosima::fastrtps::rtps::SerializedPayload_t;

namespace
{

constexpr std::size_t Encapsulation = 4;

}  // namespace

SampleType::SampleType(std::size_t payload)
{
    setName("Bench::Sample");
    m_typeSize = static_cast<std::uint32_t>((payload + Encapsulation + 3) / 4 * 4);
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
}

bool SampleType::serialize(void *data, SerializedPayload_t *payload)
{
    const auto &sample = *static_cast<const RawSample *>(data);
    FastBuffer buffer(reinterpret_cast<char *>(payload->data), payload->max_size);
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    payload->encapsulation = cdr.endianness() == Cdr::BIG_ENDIANNESS ? CDR_BE : CDR_LE;
    try
    {
        cdr.serialize_encapsulation();
        cdr << sample.Number << sample.SentAt;
        cdr << static_cast<std::uint32_t>(sample.Padding.size());
        cdr.serializeArray(sample.Padding.data(), sample.Padding.size());
    }
    catch (const eprosima::fastcdr::exception::Exception &)
    {
        return false;
    }
    payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
    return true;
}

bool SampleType::deserialize(SerializedPayload_t *payload, void *data)
{
    auto &sample = *static_cast<TakenSample *>(data);
    FastBuffer buffer(reinterpret_cast<char *>(payload->data), payload->length);
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    try
    {
        cdr.read_encapsulation();
        payload->encapsulation = cdr.endianness() == Cdr::BIG_ENDIANNESS ? CDR_BE : CDR_LE;
        cdr >> sample.Number >> sample.SentAt >> sample.Padding;
    }
    catch (const eprosima::fastcdr::exception::Exception &)
    {
        return false;
    }
    return true;
}

std::function<std::uint32_t()> SampleType::getSerializedSizeProvider(void *data)
{
    return [data]
    {
        const std::size_t padding = static_cast<const RawSample *>(data)->Padding.size();
        return static_cast<std::uint32_t>(Encapsulation + SampleOverhead + padding);
    };
}

}  // namespace Rabit::Bench
