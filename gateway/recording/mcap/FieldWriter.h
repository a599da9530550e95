#pragma once

#include <rabit/base/LittleEndian.h>
#include <rabit/mcap/McapRecords.h>

#include <type_traits>

namespace Rabit::Mcap
{

// Appends the fields of one record to bytes: little endian, each length before its content. The destructor
// completes the record.
class FieldWriter
{
public:
    FieldWriter(Bytes &to, Opcode opcode) : _to(to)
    {
        Put(opcode);
        Put(std::uint64_t{0});
        _begin = _to.size();
    }
    ~FieldWriter() { Write(_begin - sizeof(std::uint64_t), static_cast<std::uint64_t>(Size() + _beyond)); }
    FieldWriter(const FieldWriter &) = delete;
    FieldWriter &operator=(const FieldWriter &) = delete;

    // These write one field each. A ByteView is written without its length.
    template <typename T>
    void Put(T number) requires(std::is_integral_v<T> || std::is_enum_v<T>)
    {
        LittleEndian::Put(static_cast<std::make_unsigned_t<T>>(number), _to);
    }
    void Put(ByteView bytes) { _to.insert(_to.end(), bytes.begin(), bytes.end()); }
    void Put(const std::string &text)
    {
        Put(static_cast<std::uint32_t>(text.size()));
        _to.insert(_to.end(), text.begin(), text.end());
    }
    template <typename First, typename Second>
    void Put(const std::map<First, Second> &pairs)
    {
        PutPairs(pairs);
    }
    template <typename First, typename Second>
    void Put(const std::vector<std::pair<First, Second>> &pairs)
    {
        PutPairs(pairs);
    }
    // The caller writes so many further bytes of the record itself.
    void Beyond(std::size_t bytes) { _beyond = bytes; }
    // Return the size and the bytes of the content written so far.
    std::size_t Size() const { return _to.size() - _begin; }
    ByteView Content() const { return ByteView(_to).subspan(_begin); }

private:
    template <typename Pairs>
    void PutPairs(const Pairs &pairs)
    {
        Put(std::uint32_t{0});
        const std::size_t begin = _to.size();
        for (const auto &[first, second] : pairs)
        {
            Put(first);
            Put(second);
        }
        Write(begin - sizeof(std::uint32_t), static_cast<std::uint32_t>(_to.size() - begin));
    }
    template <typename T>
    void Write(std::size_t at, T value)
    {
        LittleEndian::Write(value, _to.data() + at);
    }

    Bytes &_to;
    std::size_t _begin = 0;
    std::size_t _beyond = 0;
};

}  // namespace Rabit::Mcap
