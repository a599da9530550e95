#pragma once

#include <rabit/mcap/ByteSource.h>
#include <rabit/mcap/McapRecords.h>

#include <optional>

namespace Rabit::Mcap
{

// Returns the records of a file one after the other, from its beginning, whatever the file holds. Not
// thread-safe.
class RecordScanner
{
public:
    // The content of a larger record is skipped.
    static constexpr std::uint64_t LargestRecord = 256U << 20;

    enum class End
    {
        NotYet,
        Whole,      // the magic number, behind a footer
        Truncated,  // a record, or what would tell that it was the last one, is not whole
        Damaged     // the bytes there are no record
    };
    struct Record
    {
        std::uint8_t Code = 0;
        std::uint64_t Offset = 0;
        std::uint64_t Length = 0;  // its head included
        ByteView Content;          // valid until the next record is read
        bool IsPassedOver = false;
    };

    // The source must outlive the scanner.
    explicit RecordScanner(ByteSource &source);
    // Returns the next record; nothing at the end.
    std::optional<Record> Next();
    End HowItEnded() const { return _end; }
    // The offset before which all records are whole.
    std::uint64_t GoodUntil() const { return _offset; }

private:
    std::optional<Record> EndAs(End end);

    ByteSource &_source;
    const std::uint64_t _size;
    std::uint64_t _offset = 0;
    bool _afterFooter = false;
    End _end = End::NotYet;
    Bytes _content;
};

// Returns the records within bytes, a chunk's for instance, one after the other. The bytes must outlive the
// iterator and the records. Not thread-safe.
class RecordIterator
{
public:
    explicit RecordIterator(ByteView bytes) : _bytes(bytes) {}
    struct Record
    {
        std::uint8_t Code = 0;
        std::size_t Offset = 0;
        ByteView Content;
    };
    std::optional<Record> Next();
    // True if all bytes were records.
    bool WasGood() const { return _offset == _bytes.size(); }

private:
    ByteView _bytes;
    std::size_t _offset = 0;
};

}  // namespace Rabit::Mcap
