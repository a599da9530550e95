#include <rabit/mcap/RecordScanner.h>

#include <rabit/mcap/RecordCodec.h>

#include <algorithm>
#include <array>

namespace Rabit::Mcap
{

RecordScanner::RecordScanner(ByteSource &source) : _source(source), _size(source.Size())
{
    std::array<std::uint8_t, Magic.size()> magic{};
    if (_size < magic.size())
    {
        _end = End::Truncated;
    }
    else if (!source.Read(0, magic) || magic != Magic)
    {
        _end = End::Damaged;
    }
    else
    {
        _offset = magic.size();
    }
}

std::optional<RecordScanner::Record> RecordScanner::EndAs(End end)
{
    _end = end;
    return std::nullopt;
}

std::optional<RecordScanner::Record> RecordScanner::Next()
{
    if (_end != End::NotYet)
    {
        return std::nullopt;
    }
    const std::uint64_t left = _size - _offset;
    if (_afterFooter)
    {
        std::array<std::uint8_t, Magic.size()> magic{};
        if (left < magic.size())
        {
            return EndAs(End::Truncated);
        }
        return EndAs(_source.Read(_offset, magic) && magic == Magic ? End::Whole : End::Damaged);
    }
    std::array<std::uint8_t, RecordHead> bytes{};
    if (left < bytes.size())
    {
        return EndAs(End::Truncated);
    }
    if (!_source.Read(_offset, bytes))
    {
        return EndAs(End::Damaged);
    }
    const Head head = ReadHead(bytes);
    if (head.Code == 0)
    {
        return EndAs(End::Damaged);
    }
    if (head.Length > left - bytes.size())
    {
        return EndAs(End::Truncated);
    }
    Record record;
    record.Code = head.Code;
    record.Offset = _offset;
    record.Length = bytes.size() + head.Length;
    record.IsPassedOver = head.Length > LargestRecord;
    if (!record.IsPassedOver)
    {
        _content.resize(static_cast<std::size_t>(head.Length));
        if (!_source.Read(_offset + bytes.size(), _content))
        {
            return EndAs(End::Damaged);
        }
        record.Content = _content;
    }
    _offset += record.Length;
    _afterFooter = head.Code == static_cast<std::uint8_t>(Opcode::Footer);
    return record;
}

std::optional<RecordIterator::Record> RecordIterator::Next()
{
    const ByteView left = _bytes.subspan(_offset);
    if (left.size() < RecordHead)
    {
        return std::nullopt;
    }
    const Head head = ReadHead(left.first<RecordHead>());
    if (head.Code == 0 || head.Length > left.size() - RecordHead)
    {
        return std::nullopt;
    }
    Record record;
    record.Code = head.Code;
    record.Offset = _offset;
    record.Content = left.subspan(RecordHead, static_cast<std::size_t>(head.Length));
    _offset += RecordHead + record.Content.size();
    return record;
}

}  // namespace Rabit::Mcap
