#include <rabit/ByteArrayReaderWriter.h>

#include <algorithm>
#include <cstring>

namespace Rabit
{
namespace
{

int SizeOrZero(const std::uint8_t *buffer, int size)
{
    return buffer == nullptr ? 0 : std::max(0, size);
}

}  // namespace

EndianOrder_e GetSystemEndianness()
{
    const std::uint16_t probe = 1;
    std::uint8_t firstByte = 0;
    std::memcpy(&firstByte, &probe, 1);
    return firstByte == 1 ? Endian_Little : Endian_Big;
}

ByteArrayWriter::ByteArrayWriter(std::uint8_t *byteArray, int size, EndianOrder_e endianOrder)
    : ByteArray(byteArray), ByteArraySize(SizeOrZero(byteArray, size)), Idx(0), _endianOrder(endianOrder)
{
}

void ByteArrayWriter::Clear()
{
    std::fill_n(ByteArray, ByteArraySize, std::uint8_t{0});
    Idx = 0;
}

bool ByteArrayWriter::HasRoomFor(std::int64_t bytes) const
{
    return Idx >= 0 && bytes <= static_cast<std::int64_t>(ByteArraySize) - Idx;
}

int ByteArrayWriter::WriteBytes(std::uint8_t data[], int arraySize, int startIdx, int NoBytes)
{
    if (data == nullptr || Idx < 0 || startIdx < 0 || startIdx >= arraySize)
    {
        return 0;
    }
    const int count = std::min({NoBytes, arraySize - startIdx, GetNumberBytesAvailable()});
    if (count <= 0)
    {
        return 0;
    }
    std::memcpy(ByteArray + Idx, data + startIdx, static_cast<std::size_t>(count));
    Idx += count;
    return count;
}

bool ByteArrayWriter::Write(const void *value, std::size_t size)
{
    const int length = static_cast<int>(size);
    if (!HasRoomFor(length))
    {
        return true;
    }
    std::memcpy(ByteArray + Idx, value, size);
    if (_endianOrder != GetSystemEndianness())
    {
        std::reverse(ByteArray + Idx, ByteArray + Idx + length);
    }
    Idx += length;
    return false;
}

bool ByteArrayWriter::writeString(const std::string &value)
{
    if (value.size() > static_cast<std::size_t>(MaxStringSize))
    {
        return true;
    }
    return writeString(value.data(), static_cast<int>(value.size()));
}

bool ByteArrayWriter::writeString(const char *value, int length)
{
    if (length < 0 || length > MaxStringSize || (value == nullptr && length > 0) ||
        !HasRoomFor(static_cast<std::int64_t>(length) + 2))
    {
        return true;
    }
    writeUInt16(static_cast<std::uint16_t>(length));
    std::copy_n(value, length, ByteArray + Idx);
    Idx += length;
    return false;
}

ByteArrayReader::ByteArrayReader(std::uint8_t *byteArray, int size, EndianOrder_e endianOrder)
    : ByteArray(byteArray), ByteArraySize(SizeOrZero(byteArray, size)), Idx(0), _endianOrder(endianOrder)
{
}

void ByteArrayReader::Read(void *value, std::size_t size)
{
    const int length = static_cast<int>(size);
    if (Idx < 0 || GetNumberBytesAvailable() < length)
    {
        return;
    }
    std::uint8_t *bytes = static_cast<std::uint8_t *>(value);
    std::memcpy(bytes, ByteArray + Idx, size);
    if (_endianOrder != GetSystemEndianness())
    {
        std::reverse(bytes, bytes + size);
    }
    Idx += length;
}

// The length of the string at the position, read from its 2 bytes of length; -1 if its bytes do not all lie
// within the buffer.
int ByteArrayReader::StringLengthAtIdx() const
{
    ByteArrayReader ahead(ByteArray, ByteArraySize, _endianOrder);
    ahead.Idx = Idx;
    if (Idx < 0 || ahead.GetNumberBytesAvailable() < 2)
    {
        return -1;
    }
    const int length = ahead.readUInt16();
    return length <= ahead.GetNumberBytesAvailable() ? length : -1;
}

std::string ByteArrayReader::readString()
{
    std::string value;
    readString(&value);
    return value;
}

bool ByteArrayReader::readString(std::string *value)
{
    const int length = StringLengthAtIdx();
    if (length < 0 || value == nullptr)
    {
        return true;
    }
    const std::uint8_t *begin = ByteArray + Idx + 2;
    value->assign(begin, begin + length);
    Idx += 2 + length;
    return false;
}

bool ByteArrayReader::readString(char value[], int maxSize)
{
    const int length = StringLengthAtIdx();
    if (length < 0 || value == nullptr || length >= maxSize)
    {
        return true;
    }
    std::copy_n(ByteArray + Idx + 2, length, value);
    value[length] = '\0';
    Idx += 2 + length;
    return false;
}

}  // namespace Rabit
