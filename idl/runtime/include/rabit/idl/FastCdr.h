#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/config.h>

#include <cstddef>

namespace Rabit::Idl
{

// Fast-CDR for plain XCDR1. Its versions 1 (Debian 12) and 2 (Debian 13) name the same calls differently.
class FastCdr : public eprosima::fastcdr::Cdr
{
public:
#if FASTCDR_VERSION_MAJOR < 2
    FastCdr(eprosima::fastcdr::FastBuffer &buffer, Endianness order) : Cdr(buffer, order, DDS_CDR) {}

    std::size_t Used() const
    {
        return getSerializedDataLength();
    }
    template <class T>
    void PutArray(const T *values, std::size_t count)
    {
        serializeArray(values, count);
    }
    template <class T>
    void GetArray(T *values, std::size_t count)
    {
        deserializeArray(values, count);
    }
#else
    FastCdr(eprosima::fastcdr::FastBuffer &buffer, Endianness order)
        : Cdr(buffer, order, eprosima::fastcdr::CdrVersion::DDS_CDR)
    {
    }

    std::size_t Used() const
    {
        return get_serialized_data_length();
    }
    template <class T>
    void PutArray(const T *values, std::size_t count)
    {
        serialize_array(values, count);
    }
    template <class T>
    void GetArray(T *values, std::size_t count)
    {
        deserialize_array(values, count);
    }
#endif
};

}  // namespace Rabit::Idl
