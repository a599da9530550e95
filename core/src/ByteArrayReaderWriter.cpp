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

std::uint8_t *ByteArrayWriter::GetByteArrayAddrPtrAtIdx()
{
    return ByteArray + Idx;
}

int ByteArrayWriter::GetNumberBytesAvailable()
{
    return std::max(0, ByteArraySize - Idx);
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

template <typename T>
bool ByteArrayWriter::WriteValue(T value)
{
    constexpr int size = static_cast<int>(sizeof(T));
    if (!HasRoomFor(size))
    {
        return true;
    }
    std::memcpy(ByteArray + Idx, &value, sizeof(T));
    if (_endianOrder != GetSystemEndianness())
    {
        std::reverse(ByteArray + Idx, ByteArray + Idx + size);
    }
    Idx += size;
    return false;
}

bool ByteArrayWriter::writeByte(byte value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeBool(bool value)
{
    return WriteValue(static_cast<std::uint8_t>(value ? 1 : 0));
}
bool ByteArrayWriter::writeChar(char value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeInt8(std::int8_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeUInt8(std::uint8_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeInt16(std::int16_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeUInt16(std::uint16_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeInt32(std::int32_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeUInt32(std::uint32_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeInt64(std::int64_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeUInt64(std::uint64_t value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeFloat(float value)
{
    return WriteValue(value);
}
bool ByteArrayWriter::writeDouble(double value)
{
    return WriteValue(value);
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
    WriteValue(static_cast<std::uint16_t>(length));
    std::copy_n(value, length, ByteArray + Idx);
    Idx += length;
    return false;
}

ByteArrayReader::ByteArrayReader(std::uint8_t *byteArray, int size, EndianOrder_e endianOrder)
    : ByteArray(byteArray), ByteArraySize(SizeOrZero(byteArray, size)), Idx(0), _endianOrder(endianOrder)
{
}

void ByteArrayReader::Clear()
{
    Idx = 0;
}

std::uint8_t *ByteArrayReader::GetByteArrayAddrPtrAtIdx()
{
    return ByteArray + Idx;
}

int ByteArrayReader::GetNumberBytesAvailable()
{
    return std::max(0, ByteArraySize - Idx);
}

template <typename T>
T ByteArrayReader::ReadValue()
{
    constexpr int size = static_cast<int>(sizeof(T));
    if (Idx < 0 || GetNumberBytesAvailable() < size)
    {
        return T{};
    }
    std::uint8_t bytes[sizeof(T)];
    std::copy_n(ByteArray + Idx, size, bytes);
    if (_endianOrder != GetSystemEndianness())
    {
        std::reverse(bytes, bytes + size);
    }
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    Idx += size;
    return value;
}

byte ByteArrayReader::readByte()
{
    return ReadValue<byte>();
}
bool ByteArrayReader::readBool()
{
    return ReadValue<std::uint8_t>() != 0;
}
char ByteArrayReader::readChar()
{
    return ReadValue<char>();
}
std::int8_t ByteArrayReader::readInt8()
{
    return ReadValue<std::int8_t>();
}
std::uint8_t ByteArrayReader::readUInt8()
{
    return ReadValue<std::uint8_t>();
}
std::int16_t ByteArrayReader::readInt16()
{
    return ReadValue<std::int16_t>();
}
std::uint16_t ByteArrayReader::readUInt16()
{
    return ReadValue<std::uint16_t>();
}
std::int32_t ByteArrayReader::readInt32()
{
    return ReadValue<std::int32_t>();
}
std::uint32_t ByteArrayReader::readUInt32()
{
    return ReadValue<std::uint32_t>();
}
std::int64_t ByteArrayReader::readInt64()
{
    return ReadValue<std::int64_t>();
}
std::uint64_t ByteArrayReader::readUInt64()
{
    return ReadValue<std::uint64_t>();
}
float ByteArrayReader::readFloat()
{
    return ReadValue<float>();
}
double ByteArrayReader::readDouble()
{
    return ReadValue<double>();
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
