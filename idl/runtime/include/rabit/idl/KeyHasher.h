#pragma once

#include <boost/uuid/detail/md5.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

namespace Rabit::Idl
{

// Computes a key hash by OMG DDSI-RTPS 2.3, 9.6.3.8: the key members one after another as big-endian XCDR1;
// these bytes, filled up with zeros, are the hash if no key of the type takes more than 16 bytes, else it is
// their MD5. Allocates nothing. Used by one thread at a time.
class KeyHasher
{
public:
    // fits: no key of the type takes more than 16 bytes.
    explicit KeyHasher(bool fits) : _fits(fits) {}

    template <class T>
    void Put(T value)
    {
        std::array<std::uint8_t, sizeof(T)> bytes;
        std::memcpy(bytes.data(), &value, sizeof(T));
        if constexpr (std::endian::native == std::endian::little)
        {
            for (std::size_t i = 0; i < sizeof(T) / 2; ++i)
            {
                std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
            }
        }
        static constexpr std::array<std::uint8_t, 8> zeros{};
        PutBytes(zeros.data(), (sizeof(T) - _used % sizeof(T)) % sizeof(T));
        PutBytes(bytes.data(), bytes.size());
    }
    void PutString(std::string_view text)
    {
        Put(static_cast<std::uint32_t>(text.size() + 1));
        PutBytes(text.data(), text.size());
        PutBytes("", 1);
    }
    // Ends the computation.
    std::array<std::uint8_t, 16> Finish()
    {
        if (!_fits)
        {
            using Digest = boost::uuids::detail::md5::digest_type;
            static_assert(IsDigestOfNumbers<Digest> || IsDigestOfBytes<Digest>,
                          "this version of Boost gives an MD5 in a form that is not known here");
            Digest digest;
            _md5.get_digest(digest);
            for (std::size_t i = 0; i < _short.size(); ++i)
            {
                if constexpr (IsDigestOfBytes<Digest>)
                {
                    _short[i] = static_cast<std::uint8_t>(digest[i]);
                }
                else
                {
                    _short[i] = static_cast<std::uint8_t>(digest[i / 4] >> (24 - 8 * (i % 4)));
                }
            }
        }
        return _short;
    }

private:
    // Boost gives MD5 as four numbers, the first byte the highest; since version 1.86 as bytes.
    template <class Digest>
    static constexpr bool IsDigestOfNumbers = std::is_same_v<Digest, unsigned int[4]>;
    template <class Digest>
    static constexpr bool IsDigestOfBytes = std::is_same_v<Digest, unsigned char[16]>;

    void PutBytes(const void *bytes, std::size_t size)
    {
        if (!_fits)
        {
            _md5.process_bytes(bytes, size);
        }
        else if (size <= _short.size() - _used)
        {
            std::memcpy(_short.data() + _used, bytes, size);
        }
        _used += size;
    }

    bool _fits;
    std::size_t _used = 0;
    std::array<std::uint8_t, 16> _short{};
    boost::uuids::detail::md5 _md5;
};

}  // namespace Rabit::Idl
