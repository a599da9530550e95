#pragma once

#include <rabit/base/LittleEndian.h>

#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// Appends the fields of one record to bytes: little endian, each length before its content. The destructor
// completes the record.
class FieldWriter
{
public:
    FieldWriter(Bytes &to, Opcode opcode) : _to(to)
    {
        Number(static_cast<std::uint8_t>(opcode));
        Number(std::uint64_t{0});
        _begin = _to.size();
    }
    ~FieldWriter() { Put(_begin - sizeof(std::uint64_t), static_cast<std::uint64_t>(Size() + _beyond)); }
    FieldWriter(const FieldWriter &) = delete;
    FieldWriter &operator=(const FieldWriter &) = delete;

    template <typename T>
    void Number(T value)
    {
        LittleEndian::Put(value, _to);
    }
    void Raw(ByteView bytes) { _to.insert(_to.end(), bytes.begin(), bytes.end()); }
    void Text(const std::string &text)
    {
        Number(static_cast<std::uint32_t>(text.size()));
        _to.insert(_to.end(), text.begin(), text.end());
    }
    void Texts(const TextMap &texts)
    {
        const std::size_t length = BeginArray();
        for (const auto &[key, value] : texts)
        {
            Text(key);
            Text(value);
        }
        EndArray(length);
    }
    template <typename Pairs>
    void NumberPairs(const Pairs &pairs)
    {
        const std::size_t length = BeginArray();
        for (const auto &[first, second] : pairs)
        {
            Number(first);
            Number(second);
        }
        EndArray(length);
    }
    // The caller writes so many further bytes of the record itself.
    void Beyond(std::size_t bytes) { _beyond = bytes; }
    // Return the size and the bytes of the content written so far.
    std::size_t Size() const { return _to.size() - _begin; }
    ByteView Content() const { return ByteView(_to).subspan(_begin); }

private:
    std::size_t BeginArray()
    {
        Number(std::uint32_t{0});
        return _to.size();
    }
    void EndArray(std::size_t begin)
    {
        Put(begin - sizeof(std::uint32_t), static_cast<std::uint32_t>(_to.size() - begin));
    }
    template <typename T>
    void Put(std::size_t at, T value)
    {
        LittleEndian::Write(value, _to.data() + at);
    }

    Bytes &_to;
    std::size_t _begin = 0;
    std::size_t _beyond = 0;
};

}  // namespace Rabit::Mcap
